"""Settings of the particle-swarm tracker."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.errors import TrackingError


@dataclass(frozen=True)
class SwarmOptions:
    """How the swarm searches; [O11] is Oikonomidis et al. 2011, the tracker of [T16] Table 8.

    Attributes:
        particles: Of the swarm; [T16] Table 8 has 64 and 128.
        generations: Per frame; [T16] Table 8 has 25, 40 and 45.
        seconds_per_frame: Stop a frame's search after this many seconds, reading apart; None lets it finish. What is
            found then depends on the machine.
        seed: Of the random numbers.
        cognitive, social: Pull towards a particle's own best and towards the swarm's best, c1 and c2.
        reset_every: Generations between re-initialisations of one random joint angle; 0 for none.
        reset_share: Share of the particles that are re-initialised.
        spread_shift: Standard deviation of the first generation's root positions, m.
        spread_turn: That of its root rotations, rad.
        spread_angle: That of its joint angles, rad.
        reach_shift: Roots are searched this far from the previous frame, m, along each axis.
        reach_turn: The same of rotations, rad; and of angles without limits.
        side: Pixels along the longer side of the thinned region in which poses are compared, at most.
    """

    particles: int = 64
    generations: int = 40
    seconds_per_frame: float | None = None
    seed: int = 0
    cognitive: float = 2.8
    social: float = 1.3
    reset_every: int = 3
    reset_share: float = 0.5
    spread_shift: float = 0.015
    spread_turn: float = 0.15
    spread_angle: float = 0.2
    reach_shift: float = 0.080
    reach_turn: float = 0.8
    side: int = 64

    def __post_init__(self) -> None:
        for name, low, high in (
            ("particles", 2, 100_000),
            ("generations", 1, 100_000),
            ("seed", 0, 2**63),
            ("reset_every", 0, 100_000),
            ("reset_share", 0.0, 1.0),
            ("side", 8, 10_000),
        ):
            value = getattr(self, name)
            if not low <= value <= high:
                raise TrackingError(f"{name} is {value!r}; needed a number from {low} to {high}.")
        if self.seconds_per_frame is not None and not self.seconds_per_frame > 0.0:
            raise TrackingError(f"seconds_per_frame is {self.seconds_per_frame!r}; needed more than 0, or None.")
        if not self.cognitive + self.social > 4.0:
            raise TrackingError(f"cognitive + social is {self.cognitive + self.social}; a swarm settles only above 4.")

    @property
    def constriction(self) -> float:
        """χ = 2 / |2 − ψ − √(ψ² − 4ψ)| with ψ = c1 + c2; 0.7298 for 2.8 and 1.3 (Clerc and Kennedy 2002)."""
        psi = self.cognitive + self.social
        return float(2.0 / abs(2.0 - psi - np.sqrt(psi * psi - 4.0 * psi)))

"""How long the beginning of a run takes, part by part, so that whoever waits can be told how far it is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tracker.capture.sequence import Sequence as Recording
from tracker.fitting.options import TrackOptions
from tracker.tracking.calibration_run import PASSES, name_pass

Progress = Callable[[str, float], None]

HAND, OBJECT, SHAPE_STEP = 25.0, 60.0, 0.6
"""Measured costs of placing a hand, of placing an object, and of each frame in a shape step, in frames that are tracked
in the same time."""


@dataclass(frozen=True)
class StartPlan:
    """Parts of the beginning in their order: the name of each stage, and the frames that could be tracked meanwhile."""

    parts: tuple[tuple[str, float], ...]

    @property
    def frames(self) -> float:
        """So many frames could be tracked in the time that all of it takes."""
        return sum(cost for _, cost in self.parts)

    def share(self, tell: Progress) -> Progress:
        """Takes a stage and the share of it that is done; tells `tell` the stage and the share of the whole."""
        begins, done = {}, 0.0
        for name, cost in self.parts:
            begins[name] = done, cost
            done += cost

        def told(stage: str, share: float) -> None:
            first, cost = begins[stage]
            tell(stage, (first + cost * share) / done)

        return told


def plan_start(recording: Recording, options: TrackOptions, hands: Sequence[str] = ()) -> StartPlan:
    """What `start_tracking` does, and in which order.

    Args:
        recording: What is tracked.
        options: How.
        hands: In the order in which they are placed; those of the recording when left out.
    """
    parts = [(f"placing the {name} hand", HAND) for name in hands or recording.hands]
    parts += [(f"placing {item.name}", OBJECT) for item in recording.objects]
    if options.calibrate:
        frames = len(options.frame_range(recording.frame_count))
        for number, each in enumerate(PASSES, 1):
            followed = min(frames, each.followed)
            fitted = min(followed, each.fitted) * each.options.rounds
            parts.append((name_pass("following", number), float(followed)))
            parts.append((name_pass("fitting the shape", number), SHAPE_STEP * fitted))
    return StartPlan(tuple(parts))

"""What is switched on in a run of the study."""

from __future__ import annotations

from dataclasses import dataclass

TIPS = (4, 8, 12, 16, 20)
"""Fingertips among the 21 joints: about where the paper's finger nails are."""


@dataclass(frozen=True)
class Setting:
    """One run.

    Attributes:
        features: Letters of [T16] Table 15: E edges, C collision, O optical flow, S salient points.
        cameras: The first so many of the eight.
        is_noisy: Whether images and detections are disturbed as in §4.4.1.
        joints: What S detects: "all" 21 of a hand, its "tips", or what our own hand detector "sees" in the images.
        detected: Share of the visible joints that are detected.
        iterations: Of a frame, before those with contours; without S all have contours.
        flow_weight: Of O.
        seed: Of the noise, and of the swarm.
        particles: Of a swarm that searches by E and S in place of our fit; 0 for ours.
    """

    features: str = "ECOS"
    cameras: int = 8
    is_noisy: bool = True
    joints: str = "all"
    detected: float = 0.7
    iterations: int = 10
    flow_weight: float = 0.05
    seed: int = 0
    particles: int = 0

    def has(self, letter: str) -> bool:
        return letter in self.features

    @property
    def key(self) -> str:
        """A name for files."""
        return (
            f"{self.features}_{self.cameras}_{'noisy' if self.is_noisy else 'clean'}_{self.joints}_{self.detected:g}_"
            f"{self.iterations}_{self.flow_weight:g}_{self.seed}{f'_swarm{self.particles}' if self.particles else ''}"
        )

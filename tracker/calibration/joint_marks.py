"""The joints that people marked in two or more pictures of one moment: what labels say about cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.calibration.arrangement import Corners
from tracker.capture.annotations import Annotations
from tracker.capture.camera import Camera
from tracker.capture.source_choice import find_counted

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

TELLING = ("hand", "import", "unknown", "detector")
"""Sources of joints that were found in one picture alone. A joint that was triangulated or accepted from a track agrees
with the cameras it was made with; one that was interpolated or copied was not looked for in its own picture."""


@dataclass(frozen=True, eq=False)
class JointMarks:
    """P joints as C cameras saw them.

    Attributes:
        frame: (P,) number of the frame, ascending.
        pixels: (P, C, 2) px; NaN where a camera has no mark of the joint.
    """

    frame: Integers
    pixels: Array

    @property
    def is_seen(self) -> Mask:
        """(P, C) whether a camera has a mark of the joint."""
        return np.isfinite(self.pixels[:, :, 0])

    def choose(self, mask: Mask) -> JointMarks:
        """Those of a mask (P,)."""
        return JointMarks(self.frame[mask], self.pixels[mask])

    def choose_cameras(self, numbers: Sequence[int]) -> JointMarks:
        """The joints that two or more of these cameras see, in these alone."""
        pixels = self.pixels[:, list(numbers)]
        is_shared = np.isfinite(pixels[:, :, 0]).sum(axis=1) >= 2
        return JointMarks(self.frame[is_shared], pixels[is_shared])

    def to_corners(self) -> Corners:
        """As corners of the bundle adjustment: each joint is a board of its own with its only corner at its origin."""
        camera, joint = np.nonzero(self.is_seen.T)
        pixels = self.pixels[joint, camera]
        return Corners(camera, joint, np.zeros((len(joint), 3)), pixels, np.zeros_like(pixels))


def read_marks(annotations: Annotations, cameras: Sequence[Camera]) -> JointMarks:
    """The visible joints that two or more cameras see; occluded ones were guessed, and only `TELLING` sources count."""
    numbers = {camera.id: number for number, camera in enumerate(cameras)}
    found: dict[tuple[int, str], Array] = {}
    for item in annotations.items:
        if item.camera not in numbers:
            continue
        hand = found.setdefault((item.frame, item.hand), np.full((21, len(cameras), 2), np.nan))
        is_telling = (item.points[:, 2] == 2) & find_counted(item.sources, TELLING)
        hand[is_telling, numbers[item.camera]] = item.points[is_telling, :2]
    keys = sorted(found)
    pixels = np.concatenate([found[key] for key in keys]) if keys else np.zeros((0, len(cameras), 2))
    marks = JointMarks(np.repeat(np.array([frame for frame, _ in keys], dtype=np.int64), 21), pixels)
    return marks.choose_cameras(range(len(cameras)))

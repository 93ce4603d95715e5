"""A hand that the networks found in an image."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.landmarks.square import Square, angle_of

Array = npt.NDArray[np.float64]

STEADY = (0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18)
"""Joints around which the next square lies: not the fingers' ends, which move most. MediaPipe's own."""

SHIFT, SCALE = 0.1, 2.0
"""From the box of these joints to the square: shares of the box. MediaPipe's own."""


SAME = 0.15
"""Two finds of one hand differ by less of its square; two hands that touch by more."""

TIPS = np.array([4, 8, 12, 16, 20])
"""Fingertips; the joint before each is the one nearest to it."""

BEYOND = 0.13
"""Share of a finger's last bone by which it goes on beyond the networks' fingertip: the mean of what marked fingertips
of two people say in the median (0.09 in two views of `two_camera_rgb`, 0.17 and 0.19 with box and ball). Those of a
third, which had no part in the choice, say 0.07, 0.21 and 0.22 (`d405_take001`)."""

ROW = 107
"""Numbers in a stored hand."""


@dataclass(frozen=True)
class DetectedHand:
    """21 joints in the order of `HAND_JOINTS`.

    Attributes:
        points: (21, 2) px of the image.
        points_3d: (21, 3) along the axes of the image and away from the viewer, m, as a hand of the networks' own size,
            around its middle.
        presence: 0 to 1, that there is a hand. It says nothing of single joints: those that something hides are
            invented.
        right: 0 to 1, that it is a right one; of a hand that was followed, the mean of the frames before weighs in.
    """

    points: Array
    points_3d: Array
    presence: float
    right: float

    @classmethod
    def expected(cls, points: Array, side: str) -> DetectedHand:
        """A hand that was not seen, to be looked for where its joints (21, 2) px should be."""
        return cls(points, np.zeros((21, 3)), 0.0, float(side == "right"))

    @property
    def side(self) -> str:
        return "right" if self.right >= 0.5 else "left"

    @property
    def next_square(self) -> Square:
        """Where to look for the hand in the next frame."""
        wrist, (index, middle, ring) = self.points[0], self.points[[5, 9, 13]]
        angle = angle_of(wrist, 0.5 * (0.5 * (index + ring) + middle))
        return Square.around(self.points[list(STEADY)], angle, SHIFT, SCALE)

    def with_finger_ends(self) -> DetectedHand:
        """With fingertips at the ends of the fingers, where those of our models and of annotations are.

        The networks' are where the pads are. Where depth images show the ends themselves, this changed nothing for the
        better (docs/journal.md).
        """
        points = self.points.copy()
        points[TIPS] += BEYOND * (points[TIPS] - points[TIPS - 1])
        return replace(self, points=points)

    def to_row(self) -> Array:
        """(ROW,) all of it, to be stored."""
        return np.concatenate([self.points.ravel(), self.points_3d.ravel(), [self.presence, self.right]])

    @classmethod
    def from_row(cls, row: Array) -> DetectedHand:
        """What `to_row` gave."""
        return cls(row[:42].reshape(21, 2), row[42:105].reshape(21, 3), float(row[105]), float(row[106]))

    @property
    def pixels_per_metre(self) -> float:
        """How large the networks' own hand, `points_3d`, is in the image."""
        pixels = self.points - self.points.mean(axis=0)
        metres = self.points_3d[:, :2] - self.points_3d[:, :2].mean(axis=0)
        return float(np.sum(pixels * metres) / max(np.sum(metres**2), 1e-12))

    def is_same(self, other: DetectedHand) -> bool:
        """Whether two finds are of one hand: their joints are apart by little of its size."""
        apart = float(np.linalg.norm(self.points - other.points, axis=1).mean())
        return apart < SAME * min(self.next_square.size, other.next_square.size)

"""Which joints of a detected hand something hides: the networks tell all 21 with the same confidence."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.frame import Frame
from tracker.capture.grey import is_grey
from tracker.landmarks import DetectedHand
from tracker.observation.own_color import find_own_color

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

BEFORE = 0.05
"""m; without colour a joint is hidden when what is seen there is so much nearer than the hand: the depths that the
networks tell are up to 40 mm off, so that only what is held far before the hand is told."""

BEHIND = 0.05
"""m; what is seen so much farther than the hand is beside it and hides nothing."""


def find_hidden_joints(hand: DetectedHand, frame: Frame, focal: float) -> Mask:
    """(21,) joints in front of which the images show something else; without depth none.

    In colour that is what has not the hand's own colour, in grey what is clearly nearer than the hand.

    Args:
        hand: Found in the frame's colour or grey image.
        frame: As recorded, its depth registered to its colour.
        focal: px.
    """
    if frame.depth is None or frame.color is None:
        return np.zeros(21, dtype=bool)
    seen = _look_at(frame.depth, hand.points)
    nearer = _expect(hand, seen, focal) - seen
    if is_grey(frame.color):
        return nearer > BEFORE
    is_own = find_own_color(frame.color, frame.depth, hand.points, focal)
    is_hand = np.array([is_own[around].any() for around in _around(hand.points)])
    return ~is_hand & (nearer > -BEHIND)


def _expect(hand: DetectedHand, seen: Array, focal: float) -> Array:
    """(21,) m, depth of the hand's surface at each joint, from its shape and from what most joints' pixels show."""
    if np.isnan(seen).all():
        return seen
    deeper = hand.pixels_per_metre * float(np.nanmedian(seen)) / focal * hand.points_3d[:, 2]
    return np.nanmedian(seen - deeper) + deeper


def _look_at(depth: npt.NDArray[np.float32], points: Array) -> Array:
    """(21,) m, depth at points (21, 2) px; NaN where there is none."""
    seen = np.full(len(points), np.nan)
    for joint, around in enumerate(_around(points)):
        values = depth[around]
        if (values > 0).any():
            seen[joint] = np.median(values[values > 0])
    return seen


def _around(points: Array) -> list[tuple[slice, slice]]:
    """The 3 x 3 pixels of an image around each point; none of a point outside of it."""
    return [
        (slice(max(0, row - 1), max(0, row + 2)), slice(max(0, column - 1), max(0, column + 2)))
        for column, row in np.rint(points).astype(int).tolist()
    ]

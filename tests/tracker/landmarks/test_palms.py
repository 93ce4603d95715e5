"""Palms: anchors, boxes that overlap, and squares around hands."""

from __future__ import annotations

import numpy as np

from tracker.landmarks.palms import PIXELS, find_palms


def _say(*palms: tuple[int, float, float]) -> dict[str, np.ndarray]:
    """What the network would say: of some anchors a score, and a box of so many px with its wrist below the middle."""
    boxes = np.zeros((1, 2016, 18), dtype=np.float32)
    scores = np.full((1, 2016, 1), -20.0, dtype=np.float32)
    for anchor, score, size in palms:
        scores[0, anchor] = score
        boxes[0, anchor, 2:4] = size
        boxes[0, anchor, 4:] = [0.0, 0.3 * size, *([0.0, 0.0]), 0.0, -0.5 * size, *([0.0, 0.0] * 4)]
    return {"boxes": boxes, "scores": scores}


def test_boxes_of_one_palm_are_one_and_others_stay() -> None:
    image = np.zeros((PIXELS, PIXELS, 3), dtype=np.uint8)
    same = 24 * 2 * 10 + 20  # row 10, column 10 of the finer grid; the next anchor lies in the same cell
    far = 24 * 2 * 20 + 40
    found = find_palms(lambda _: _say((same, 3.0, 40.0), (same + 1, 2.0, 40.0), (far, 4.0, 40.0)), image)
    middles = [np.array([84.0, 84.0]) - 0.5, np.array([164.0, 164.0]) - 0.5]
    assert len(found) == 2
    for square, middle in zip(found, middles[::-1], strict=True):  # the most certain first
        assert square.angle == 0.0
        assert square.size == 2.6 * 40.0
        np.testing.assert_allclose(square.center, middle - [0.0, 20.0], atol=1e-4)


def test_what_is_unlikely_is_no_palm() -> None:
    assert find_palms(lambda _: _say((5, -2.0, 40.0)), np.zeros((50, 80, 3), dtype=np.uint8)) == []

"""Of detections that overlap, the most confident."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def compute_overlaps(one: Array, other: Array) -> Array:
    """(M, N) intersection over union of boxes (M, 4) and (N, 4): left, top, right, bottom, px."""
    assert one.ndim == other.ndim == 2 and one.shape[1] == other.shape[1] == 4
    left_top = np.maximum(one[:, None, :2], other[None, :, :2])
    right_bottom = np.minimum(one[:, None, 2:], other[None, :, 2:])
    common = np.prod(np.maximum(right_bottom - left_top, 0.0), axis=2)
    areas = [np.prod(np.maximum(boxes[:, 2:] - boxes[:, :2], 0.0), axis=1) for boxes in (one, other)]
    union = areas[0][:, None] + areas[1][None] - common
    return common / np.maximum(union, 1e-12)


def suppress(boxes: Array, confidences: Array, max_overlap: float) -> npt.NDArray[np.int64]:
    """Rows of the boxes (N, 4) that stay, most confident first: none overlaps a better one by more, [T16] §3.2.5.

    Equal confidences keep their order, so the result does not depend on chance.
    """
    assert boxes.shape == (len(confidences), 4)
    order = np.argsort(-confidences, kind="stable")
    overlaps = compute_overlaps(boxes, boxes)
    kept: list[int] = []
    for candidate in order:
        if all(overlaps[candidate, better] <= max_overlap for better in kept):
            kept.append(int(candidate))
    return np.array(kept, dtype=np.int64)

"""Find palms in a whole image."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.landmarks.network import Run, load_network
from tracker.landmarks.square import Square, angle_of

Array = npt.NDArray[np.float64]

PIXELS = 192
"""Side of the network's image."""

GRIDS = ((24, 2), (12, 6))
"""Cells a side, and anchors in each cell, of the boxes that the network tells, in their order."""

MIN_SCORE, MAX_OVERLAP = 0.15, 0.3
"""Of boxes that are looked at; boxes that overlap by more are one palm. MediaPipe looks at 0.5 and more; the other
network refuses what is no hand. Of 140 single real images 114 give their hand at 0.15, 100 at 0.5
(docs/journal.md)."""

WRIST, MIDDLE = 0, 2
"""Which of a palm's seven points are its wrist and the base of its middle finger."""

SHIFT, SCALE = 0.5, 2.6
"""From a palm's box to its hand's square: shares of the box. MediaPipe's own."""


def load_palm_network(threads: int = 1) -> Run:
    return load_network("palms", ("boxes", "scores"), threads)


def find_palms(network: Run, image: npt.NDArray[np.uint8], turn: int = 0) -> list[Square]:
    """Squares around the hands of an image (H, W, 3), seen turned by this many quarters; the most certain first."""
    height, width = image.shape[:2]
    whole = Square(np.array([0.5 * (width - 1), 0.5 * (height - 1)]), float(max(height, width)), 0.5 * np.pi * turn)
    told = network(whole.cut(image, PIXELS))
    scores = told["scores"].reshape(-1).astype(np.float64)
    likely = np.flatnonzero(scores > np.log(MIN_SCORE / (1.0 - MIN_SCORE)))
    likely = likely[np.argsort(-scores[likely], kind="stable")]
    values = told["boxes"].reshape(-1, 18)[likely].astype(np.float64)
    centers = values[:, :2] + PIXELS * _anchors()[likely]
    corners = np.concatenate([centers - 0.5 * values[:, 2:4], centers + 0.5 * values[:, 2:4]], axis=1)
    points = values[:, 4:].reshape(-1, 7, 2) + PIXELS * _anchors()[likely, None]
    certain = 1.0 / (1.0 + np.exp(-scores[likely]))
    found = []
    for members in _gather(corners):
        weights = certain[members] / certain[members].sum()
        box, own = weights @ corners[members], np.einsum("m,mpx->px", weights, points[members])
        found.append(_square_of(whole, box, own))
    return found


def _square_of(whole: Square, box: Array, points: Array) -> Square:
    """The hand's square from its palm's box (4,) and points (7, 2), px of the network's image."""
    scale = whole.size / PIXELS
    wrist, middle = whole.to_image(points[[WRIST, MIDDLE]] - 0.5, PIXELS)
    angle = angle_of(wrist, middle)
    width, height = scale * (box[2:] - box[:2])
    up = np.array([np.sin(angle), -np.cos(angle)])
    middle_of_box = whole.to_image(0.5 * (box[:2] + box[2:])[None] - 0.5, PIXELS)[0]
    return Square(middle_of_box + SHIFT * height * up, SCALE * float(max(width, height)), angle)


def _gather(corners: Array) -> list[npt.NDArray[np.int64]]:
    """Indices of boxes (N, 4), the best first, that overlap the best that is left, again and again."""
    groups, left = [], np.arange(len(corners))
    while len(left):
        is_same = _overlap(corners[left[0]], corners[left]) > MAX_OVERLAP
        is_same[0] = True
        groups.append(left[is_same])
        left = left[~is_same]
    return groups


def _overlap(box: Array, others: Array) -> Array:
    """(N,) intersection over union of a box (4,) with others (N, 4)."""
    shared = np.minimum(box[2:], others[:, 2:]) - np.maximum(box[:2], others[:, :2])
    area = np.prod(np.maximum(shared, 0.0), axis=1)
    whole = np.prod(box[2:] - box[:2]) + np.prod(others[:, 2:] - others[:, :2], axis=1) - area
    return area / np.maximum(whole, 1e-9)


@cache
def _anchors() -> Array:
    """(2016, 2) middles of the anchors, shares of the image."""
    places = []
    for cells, each in GRIDS:
        rows, columns = np.divmod(np.arange(cells * cells), cells)
        places.append(np.repeat((np.stack([columns, rows], axis=1) + 0.5) / cells, each, axis=0))
    return np.concatenate(places)

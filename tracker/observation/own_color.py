"""Which pixels have a hand's own colour: what it holds, its sleeve and the room have another.

Skin colour in general (`skin.py`) takes a warm white box for a hand. Where the joints of a hand are known roughly, its
own pixels tell its colour, and those around it the colours of everything else.
"""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.grey import is_grey
from tracker.observation.skin import compute_skin_log_ratio

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

PALM = (0, 1, 2, 5, 9, 13, 17)
"""Joints around the palm, of the 21."""
FINGERS = tuple((joint, joint + 1) for base in (1, 5, 9, 13, 17) for joint in range(base, base + 3))

INNER, NEAR, AROUND = 0.006, 0.020, 0.080
"""m: pixels so near to a bone are of the finger, so near perhaps; those farther than the last are not looked at."""

REACH = 0.20
"""Pixels so much nearer or farther than the hand are not looked at, m."""

ON, BESIDE, FAR = 0.6, 0.5, 0.4
"""How likely a pixel is to be of the hand before its colour is looked at: on a bone, near one, elsewhere."""

LIGHTS, TINTS, TINT_STEP = 6, 32, 2
"""Cells of the colours' histogram: of lightness, and of each of the two colour axes (CIE L*a*b*, 8 bits)."""

HOLE = 0.66
"""A pixel with this share of the hand's around it is of the hand too: nails, shadows, lights."""

RARE = 2e-4
"""Share of the pixels below which a colour tells little."""


def find_own_color(color: npt.NDArray[np.uint8], depth: npt.NDArray[np.float32], joints: Array, focal: float) -> Mask:
    """(H, W) pixels with depth that have the colour of a hand, those far from it left out.

    Args:
        color: (H, W, 3) red green blue.
        depth: (H, W) m, 0 where there is none.
        joints: (21, 2) px, roughly; some may be wrong.
        focal: px.
    """
    mask = np.zeros(depth.shape, dtype=bool)
    distance = _distance_of(depth, joints)
    if distance is None:
        return mask
    pixels = focal / distance
    low = np.maximum(np.floor(joints.min(axis=0) - AROUND * pixels), 0).astype(int)
    high = np.minimum(np.ceil(joints.max(axis=0) + AROUND * pixels) + 1, depth.shape[::-1]).astype(int)
    if np.any(high - low < 8):
        return mask
    window = slice(low[1], high[1]), slice(low[0], high[0])
    zone = (depth[window] > 0) & (np.abs(depth[window] - distance) < REACH)
    if not zone.any():
        return mask
    place, seen = _place(joints - low, zone.shape, pixels), np.ascontiguousarray(color[window])
    mask[window] = zone & (place > FAR) if is_grey(seen) else _separate(seen, zone, place)
    return mask


def _distance_of(depth: npt.NDArray[np.float32], joints: Array) -> float | None:
    """Median depth at the joints, m."""
    columns, rows = np.rint(joints).astype(int).T
    inside = (rows >= 0) & (rows < depth.shape[0]) & (columns >= 0) & (columns < depth.shape[1])
    values = depth[rows[inside], columns[inside]]
    values = values[values > 0]
    return float(np.median(values)) if values.size else None


def _place(joints: Array, shape: tuple[int, ...], pixels: float) -> npt.NDArray[np.float32]:
    """(h, w) how likely a pixel is to be of the hand by where it lies."""
    places = np.rint(joints).astype(np.int32)
    core = np.zeros(shape, dtype=np.uint8)
    for first, second in FINGERS:
        cv2.line(core, places[first].tolist(), places[second].tolist(), 1, 2 * max(1, round(INNER * pixels)) - 1)
    cv2.fillConvexPoly(core, cv2.convexHull(places[list(PALM)]), 1)
    near = cv2.dilate(core, np.ones((2 * int(NEAR * pixels) + 1,) * 2, dtype=np.uint8))
    return np.where(core > 0, ON, np.where(near > 0, BESIDE, FAR)).astype(np.float32)


def _separate(color: npt.NDArray[np.uint8], zone: Mask, place: npt.NDArray[np.float32]) -> Mask:
    """Pixels of the zone whose colour is rather the hand's than that of the rest."""
    cells = _cells(color)
    skin = compute_skin_log_ratio(color)
    own = 1.0 / (1.0 + (1.0 - place) / place * np.exp(-2.0 * skin))
    hand, rest = _histogram(cells[zone], own[zone]), _histogram(cells[zone], 1.0 - own[zone])
    count = zone.astype(np.float32)
    ratio = np.log((hand + RARE) / (rest + RARE))[cells] * count
    smooth = cv2.blur(ratio, (5, 5)) / np.maximum(cv2.blur(count, (5, 5)), 1e-3)
    is_own = zone & (smooth + 0.5 * skin > 0.0)
    around = cv2.blur(is_own.astype(np.float32), (9, 9)) / np.maximum(cv2.blur(count, (9, 9)), 1e-3)
    return is_own | (zone & (around > HOLE))


def _cells(color: npt.NDArray[np.uint8]) -> npt.NDArray[np.int64]:
    """(h, w) cell of the histogram of each pixel."""
    lab = cv2.cvtColor(cv2.GaussianBlur(color, (3, 3), 0), cv2.COLOR_RGB2LAB).astype(np.int64)
    tints = np.clip((lab[..., 1:] - 128) // TINT_STEP + TINTS // 2, 0, TINTS - 1)
    return (lab[..., 0] * LIGHTS // 256 * TINTS + tints[..., 0]) * TINTS + tints[..., 1]


def _histogram(cells: npt.NDArray[np.int64], weights: npt.NDArray[np.floating]) -> npt.NDArray[np.float32]:
    """Share of the weights in each cell, smoothed; the sum is nearly 1."""
    counts = np.bincount(cells, weights=weights, minlength=LIGHTS * TINTS * TINTS).astype(np.float32)
    layers = counts.reshape(LIGHTS, TINTS, TINTS)
    smooth = np.stack([cv2.GaussianBlur(layer, (0, 0), 1.0) for layer in layers])
    smooth[1:-1] = 0.15 * smooth[:-2] + 0.7 * smooth[1:-1] + 0.15 * smooth[2:]
    return (smooth / (smooth.sum() + 1.0)).ravel()

"""Small pictures of scans for lists: the longest way up, seen from the flat side."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from server.scans.geometry import choose_points
from tracker import Scan

SIZE_PX = 80
MOST_POINTS = 20_000
MARGIN = 0.06
"""Share of the picture that stays free on each side."""
PLAIN = (188, 178, 170)
"""RGB of a scan without colours."""

Array = npt.NDArray[np.float64]


def draw_thumbnail(scan: Scan, is_kept: npt.NDArray[np.bool_], digest: str) -> bytes:
    """A square PNG of the points that are kept, on transparent ground."""
    return draw_picture(scan, is_kept, digest, SIZE_PX)[0]


def draw_picture(
    scan: Scan, is_kept: npt.NDArray[np.bool_], digest: str, size_px: int, turn: Array | None = None
) -> tuple[bytes, float]:
    """Such a picture of `size_px` a side, and the length of a side in the unit of the scan's points. Far points are
    drawn first, so that near ones hide them. `turn` (3, 3) is as `find_upright` gives it, which is asked otherwise."""
    kept = np.flatnonzero(is_kept)
    chosen = kept[choose_points(len(kept), MOST_POINTS, digest)]
    image = np.zeros((size_px, size_px, 4), dtype=np.uint8)
    side = 0.0
    if len(chosen):
        turn = find_upright(scan.points[chosen]) if turn is None else turn
        points = (scan.points[chosen] - scan.points[chosen].mean(axis=0)) @ turn.T
        facing = scan.normals[chosen] @ turn[2]
        colors = np.full((len(chosen), 3), PLAIN) if scan.colors is None else scan.colors[chosen]
        low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        side = max(float((high - low).max()), 1e-9) / (1.0 - 2.0 * MARGIN)
        scale = size_px / side
        middle = (low + high) / 2.0
        columns = np.floor(size_px / 2.0 + scale * (points[:, 0] - middle[0])).astype(int)
        rows = np.floor(size_px / 2.0 - scale * (points[:, 1] - middle[1])).astype(int)
        shade = (0.35 + 0.65 * np.abs(facing))[:, None]
        order = np.argsort(points[:, 2], kind="stable")
        painted = np.concatenate([shade * colors, np.full((len(chosen), 1), 255.0)], axis=1).astype(np.uint8)[order]
        for down, right in ((0, 0), (0, 1), (1, 0), (1, 1)):
            image[np.clip(rows[order] + down, 0, size_px - 1), np.clip(columns[order] + right, 0, size_px - 1)] = (
                painted
            )
    done, data = cv2.imencode(".png", cv2.cvtColor(image, cv2.COLOR_RGBA2BGRA))
    assert done
    return data.tobytes(), side


def find_upright(points: Array) -> Array:
    """(3, 3) rotation whose rows are right, up, towards the eye: the longest axis is up with the wider end on top (the
    fingers, not the wrist), the thinnest one looks at the eye."""
    centred = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(centred.T @ centred)  # ascending
    up, right = axes[:, 2], axes[:, 1]
    along, across = centred @ up, np.abs(centred @ right)
    is_top = along > np.median(along)
    if across[is_top].mean() < across[~is_top].mean():
        up = -up
    return np.stack([right, up, np.cross(right, up)])

"""What the images show around the joints of a label: depth, or nothing at all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from tracker import Sequence

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

WINDOW = 3
"""Depth is looked at this far around a joint, px: a label may lie beside the silhouette by as much."""
NEAR = 40
"""Something to be seen is looked for this far around a joint first, px, then in the whole image."""
BLACK = 12
"""Largest value of a channel that counts as black: a background that was cut out, and what JPEG makes of it."""
MASKED_SHARE = 0.3
"""An image of which more than this share is black had its background cut out."""


@dataclass(frozen=True)
class Surroundings:
    """Around the 21 joints of a label.

    Attributes:
        depths: (21, K) sorted depths within WINDOW of each joint, m; NaN where there are none, or where it is not
            visible.
        to_depth: (21,) px to the nearest pixel that has depth; NaN where it is not known.
        to_content: (21,) px to the nearest pixel that shows anything, in an image whose background was cut out; NaN
            where it is not known.
    """

    depths: Array
    to_depth: Array
    to_content: Array


class Images:
    """The images of a recording, the one that was asked for last kept."""

    def __init__(self, recording: Sequence) -> None:
        self._recording = recording
        self._place: tuple[str, int] = ("", -1)
        self._depth: Array | None = None
        self._content: Mask | None = None
        self._masked: dict[str, bool] = {}

    def load(self, camera_id: str, frame: int) -> tuple[Array | None, Mask | None]:
        """(H, W) depth, m, where there is a depth camera; where something is seen, if the background was cut out."""
        if self._place != (camera_id, frame):
            camera = self._recording.camera(camera_id)
            self._depth = None
            if camera.has_depth:
                self._depth = self._recording.depth_raw(frame, camera_id).astype(np.float64) * camera.depth_scale
            self._content = self._find_content(camera_id, frame)
            self._place = camera_id, frame
        return self._depth, self._content

    def _find_content(self, camera_id: str, frame: int) -> Mask | None:
        """Whether a camera's background was cut out is seen from the first image of it that is looked at."""
        if not self._recording.camera(camera_id).has_color or not self._masked.get(camera_id, True):
            return None
        color = self._recording.color(frame, camera_id)
        content: Mask = color.max(axis=2) > BLACK
        if self._depth is not None and self._depth.shape == content.shape:
            content |= self._depth > 0
        self._masked.setdefault(camera_id, bool(1.0 - content.mean() > MASKED_SHARE))
        return content if self._masked[camera_id] else None


def look_around(images: Images, camera_id: str, frame: int, points: Array) -> Surroundings:
    """Look at the images around joints: (21, 3) x, y px and v."""
    depth, content = images.load(camera_id, frame)
    side = 2 * WINDOW + 1
    depths = np.full((21, side * side), np.nan)
    to_depth, to_content = np.full(21, np.nan), np.full(21, np.nan)
    for joint in np.flatnonzero(points[:, 2] > 0):
        at = points[joint, :2]
        if points[joint, 2] == 2 and depth is not None:
            values = _cut(depth, at, WINDOW)
            values = np.sort(values[values > 0])
            depths[joint, : len(values)] = values
            to_depth[joint] = 0.0 if len(values) else _measure(depth > 0, at)
        if content is not None:
            to_content[joint] = _measure(content, at)
    return Surroundings(depths, to_depth, to_content)


def _cut(image: npt.NDArray, at: Array, reach: int) -> npt.NDArray:
    """The pixels of an image within `reach` of a position; none where that is outside."""
    height, width = image.shape[:2]
    column, row = round(at[0]), round(at[1])
    rows = slice(max(0, row - reach), max(0, min(height, row + reach + 1)))
    columns = slice(max(0, column - reach), max(0, min(width, column + reach + 1)))
    return image[rows, columns]


def _measure(mask: Mask, at: Array) -> float:
    """px from a position to the nearest pixel of a mask, at most the image's diagonal; NaN outside the image."""
    height, width = mask.shape
    if not (-0.5 <= at[0] < width - 0.5 and -0.5 <= at[1] < height - 0.5):
        return np.nan
    diagonal = float(np.hypot(height, width))
    for reach in (NEAR, max(height, width)):
        rows, columns = np.nonzero(_cut(mask, at, reach))
        corner = max(0, round(at[1]) - reach), max(0, round(at[0]) - reach)
        distances = np.hypot(rows + corner[0] - at[1], columns + corner[1] - at[0])
        nearest = float(distances.min(initial=diagonal))
        if nearest <= reach:
            return nearest
    return diagonal

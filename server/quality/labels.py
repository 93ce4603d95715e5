"""The labels of a recording as arrays, with what the depth images say at their joints."""

from __future__ import annotations

import uuid
import warnings
from collections import OrderedDict
from collections.abc import Sequence as Many
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from tracker import Sequence

Array = npt.NDArray[np.float64]

WINDOW = 3
"""Depth is looked at this far around a joint, px: a label may lie beside the silhouette by as much."""


def find_median(values: Array, axis: int | None = None) -> Array:
    """The median of what is known; NaN where nothing is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        return np.nanmedian(values, axis=axis)


@dataclass(frozen=True)
class Label:
    """One annotation.

    Attributes:
        points: (21, 3) x, y px and v.
        depths: (21, K) sorted depths around each joint, m; NaN where there are none, or where it is not visible.
    """

    id: uuid.UUID
    revision: int
    camera: str
    frame: int
    hand: str
    points: Array
    depths: Array

    @cached_property
    def is_placed(self) -> npt.NDArray[np.bool_]:
        return self.points[:, 2] > 0

    @cached_property
    def pixels(self) -> Array:
        """(21, 2) px, NaN where nothing is placed."""
        return np.where(self.is_placed[:, None], self.points[:, :2], np.nan)

    @cached_property
    def depth(self) -> Array:
        """(21,) m, NaN unknown."""
        return find_median(self.depths, axis=1)

    @cached_property
    def depth_range(self) -> Array:
        """(3, 21) m: depths that the joint may have, for at an edge some of the pixels around are of something else."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            return np.nanpercentile(self.depths, (10, 50, 90), axis=1)

    @cached_property
    def size_px(self) -> float:
        """Of the hand in the image: the longer side of the box around its joints."""
        if not self.is_placed.any():
            return 0.0
        return float(np.max(np.nanmax(self.pixels, axis=0) - np.nanmin(self.pixels, axis=0)))


class DepthReader:
    """Reads the depth at joints once for each revision of a label."""

    def __init__(self, kept: int = 50_000) -> None:
        self._known: OrderedDict[tuple[uuid.UUID, int], Array] = OrderedDict()
        self._kept = kept

    def read(self, recording: Sequence, rows: Many) -> list[Label]:
        """Labels of annotation rows, in their order (by frame)."""
        last: tuple[tuple[str, int], Array | None] = (("", -1), None)
        labels = []
        for row in rows:
            points = np.array(row.points, dtype=np.float64)
            depths = self._known.get((row.id, row.revision))
            if depths is None:
                if last[0] != (row.camera, row.frame):
                    last = (row.camera, row.frame), _load(recording, row.camera, row.frame)
                depths = _around(last[1], points)
                self._known[row.id, row.revision] = depths
                while len(self._known) > self._kept:
                    self._known.popitem(last=False)
            labels.append(Label(row.id, row.revision, row.camera, row.frame, row.hand, points, depths))
        return labels


def _load(recording: Sequence, camera_id: str, frame: int) -> Array | None:
    camera = recording.camera(camera_id)
    if not camera.has_depth:
        return None
    return recording.depth_raw(frame, camera_id).astype(np.float64) * camera.depth_scale


def _around(depth: Array | None, points: Array) -> Array:
    side = 2 * WINDOW + 1
    found = np.full((21, side * side), np.nan)
    if depth is None:
        return found
    height, width = depth.shape
    for joint in np.flatnonzero(points[:, 2] == 2):
        column, row = round(points[joint, 0]), round(points[joint, 1])
        rows = slice(max(0, row - WINDOW), max(0, min(height, row + WINDOW + 1)))
        columns = slice(max(0, column - WINDOW), max(0, min(width, column + WINDOW + 1)))
        values = depth[rows, columns]
        values = np.sort(values[values > 0])
        found[joint, : len(values)] = values
    return found

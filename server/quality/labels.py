"""The labels of a recording as arrays, with what the images say at their joints."""

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

from server.annotations.sources import read_sources
from server.quality.surroundings import Images, Surroundings, look_around

if TYPE_CHECKING:
    from tracker import Sequence

Array = npt.NDArray[np.float64]


def find_median(values: Array, axis: int | None = None) -> Array:
    """The median of what is known; NaN where nothing is. As `np.nanmedian`, a tenth of its time for few values."""
    if axis is None:
        values, axis = values.ravel(), 0
    ordered = np.sort(values, axis=axis)  # NaN last
    known = np.isfinite(ordered).sum(axis=axis, keepdims=True)
    below = np.take_along_axis(ordered, np.maximum(known - 1, 0) // 2, axis)
    above = np.take_along_axis(ordered, np.minimum(known // 2, ordered.shape[axis] - 1), axis)
    return np.where(known > 0, 0.5 * (below + above), np.nan).squeeze(axis)


@dataclass(frozen=True)
class Label:
    """One annotation.

    Attributes:
        points: (21, 3) x, y px and v.
        around: What the images show around each joint.
        is_independent: (21,) joints that no track had a part in.
    """

    id: uuid.UUID
    revision: int
    camera: str
    frame: int
    hand: str
    points: Array
    around: Surroundings
    is_independent: npt.NDArray[np.bool_]

    @property
    def depths(self) -> Array:
        """(21, K) sorted depths around each joint, m; NaN where there are none, or where it is not visible."""
        return self.around.depths

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


class LabelReader:
    """Reads each revision of a label once, with the images around its joints."""

    def __init__(self, kept: int = 50_000) -> None:
        self._known: OrderedDict[tuple[uuid.UUID, int], Label] = OrderedDict()
        self._kept = kept

    def read(self, recording: Sequence, rows: Many) -> list[Label]:
        """Labels of annotation rows, in their order (by frame)."""
        from tracker.capture import JUDGING, find_counted

        images = Images(recording)
        labels = []
        for row in rows:
            label = self._known.get((row.id, row.revision))
            if label is None:
                points = np.array(row.points, dtype=np.float64)
                around = look_around(images, row.camera, row.frame, points)
                counted = find_counted(read_sources(row.sources), JUDGING)
                label = Label(row.id, row.revision, row.camera, row.frame, row.hand, points, around, counted)
                self._known[row.id, row.revision] = label
                while len(self._known) > self._kept:
                    self._known.popitem(last=False)
            labels.append(label)
        return labels

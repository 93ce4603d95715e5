"""The same hand in several cameras: where its joints are in space, and which camera disagrees."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from tracker import Camera

Array = npt.NDArray[np.float64]
Marks = Mapping[tuple[str, int, str], Array]
"""(21, 2) px of hands by camera, frame and hand; NaN where a joint is not known."""


@dataclass(frozen=True)
class Views:
    """A hand that two cameras or more see in a frame.

    Attributes:
        cameras: C of them.
        points: (21, 3) world, m; NaN where the views make no point.
        residuals: (21, C) px from each mark to the point.
        left_out: (21, C) px from each mark to the point that the other cameras' marks alone make.
    """

    frame: int
    hand: str
    cameras: tuple[str, ...]
    points: Array
    residuals: Array
    left_out: Array


def triangulate_views(marks: Marks, cameras: Mapping[str, Camera]) -> list[Views]:
    """All hands that are marked in two cameras or more, by frame."""
    from tracker.capture import triangulate

    together: dict[tuple[int, str], dict[str, Array]] = defaultdict(dict)
    for (camera, frame, hand), pixels in marks.items():
        together[frame, hand][camera] = pixels
    hands = sorted(place for place, views in together.items() if len(views) >= 2)
    names = [name for name in cameras if any(name in together[place] for place in hands)]
    if not hands:
        return []
    table = np.full((len(hands), 21, len(names), 2), np.nan)
    for row, place in enumerate(hands):
        for name, pixels in together[place].items():
            table[row, :, names.index(name)] = pixels
    found = triangulate([cameras[name] for name in names], table.reshape(-1, len(names), 2))
    points = found.points.reshape(len(hands), 21, 3)
    residuals, left_out = (
        values.reshape(len(hands), 21, len(names)) for values in (found.residuals, found.left_out_residuals)
    )
    views = []
    for row, place in enumerate(hands):
        columns = [column for column, name in enumerate(names) if name in together[place]]
        of = tuple(names[column] for column in columns)
        views.append(Views(*place, of, points[row], residuals[row][:, columns], left_out[row][:, columns]))
    return views


def measure_size(pixels: Array) -> float:
    """Longer side of the box around (21, 2) px; 0 where nothing is known."""
    known = pixels[np.isfinite(pixels).all(axis=1)]
    return float(np.ptp(known, axis=0).max()) if len(known) else 0.0

"""How far found joints lie from marked ones, and whether the verdicts on them are right."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from benchmarks.real_marks.marked import TIPS

Array = npt.NDArray[np.float64]

WRONG = 2.0
"""A visible fingertip more than this many limits off is in a wrong place."""


@dataclass(frozen=True)
class Agreement:
    """Found joints against marks.

    Attributes:
        tips: Fingertips that both passes marked.
        within: Share of them that lie within the limit.
        median: px.
        false_alarms: Frames called lost whose marked joints are all right.
        misses: Frames called `ok` with a fingertip in a wrong place.
        marked: Frames with marks.
    """

    tips: int
    within: float
    median: float
    false_alarms: list[int]
    misses: list[int]
    marked: int


def compare(marks: Mapping[int, Array], joints: Mapping[int, Array], lost: set[int], limit: float) -> Agreement:
    """Compare joints (21, 2) px with marks (21, 2) px, NaN where there is none, frame by frame.

    Args:
        marks: By frame.
        joints: By frame; a frame that is missing has every joint in a wrong place.
        lost: Frames that are not to be believed.
        limit: px.
    """
    errors, false_alarms, misses = [], [], []
    for frame, wanted in marks.items():
        found = np.nan_to_num(joints.get(frame, np.full((21, 2), np.nan)), nan=np.inf)
        off = np.linalg.norm(found - wanted, axis=1)
        tips = off[TIPS][~np.isnan(off[TIPS])]
        errors.append(tips)
        if frame in lost and tips.size and tips.max() <= limit:
            false_alarms.append(frame)
        if frame not in lost and tips.size and tips.max() > WRONG * limit:
            misses.append(frame)
    every = np.concatenate(errors)
    within = float(np.mean(every <= limit)) if every.size else float("nan")
    return Agreement(every.size, within, float(np.median(every)), false_alarms, misses, len(marks))

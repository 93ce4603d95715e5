"""A study: which trials it needs, the rows that come of them, and how the rows are shown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from benchmarks.studies.blocks import Block
from benchmarks.studies.trial import Results, Trial

Row = dict[str, Any]

HAND_HAND = ("01", "04", "09", "12")
HAND_OBJECT = ("15", "17", "18", "20")
TITLES = {
    "01": "Walking",
    "04": "Tips Touching",
    "09": "Flying",
    "12": "Bunny",
    "15": "Moving a Ball",
    "17": "Bending a Pipe",
    "18": "Bending a Rope",
    "20": "Moving a Cube",
}
SETTING_STEP = 3
"""Ablations follow every third frame of the whole sequences: larger motions, in which settings differ."""


@dataclass(frozen=True)
class Extent:
    """How much is run.

    Attributes:
        quick: Only the first frames: to try the harness, not to quote.
        frames: Of each sequence; None is all of them.
    """

    quick: bool = False

    @property
    def frames(self) -> int | None:
        return 40 if self.quick else None


@dataclass(frozen=True)
class Study:
    """One table or figure.

    Attributes:
        name: Of its files, such as "table_02".
        title: Its heading.
        paper: What of T16 it is the analogue of.
        question: What it asks.
        same: In what it is comparable with the paper.
        differs: In what it is not.
        trials: Those it needs.
        tabulate: Their results as plain rows.
        show: Rows as tables, plots and text.
    """

    name: str
    title: str
    paper: str
    question: str
    same: str
    differs: str
    trials: Callable[[Extent], Sequence[Trial]]
    tabulate: Callable[[Results, Extent], list[Row]]
    show: Callable[[list[Row]], list[Block]]

"""One bar: what must be shown, the trials it needs, and how they are judged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from benchmarks.studies.study import Row
from benchmarks.studies.trial import NotMeasured, Results, Trial


@dataclass(frozen=True)
class Verdict:
    """What came out.

    Attributes:
        measured: In words and numbers.
        is_met: Whether that meets the bar.
        ratio: Measured over allowed, where that makes sense: at most 1 is met. NaN otherwise.
        note: What to know when reading it.
    """

    measured: str
    is_met: bool
    ratio: float = float("nan")
    note: str = ""


@dataclass(frozen=True)
class Bar:
    """A line of the project's table of what the tracker must show.

    Attributes:
        group: What is looked at.
        what: The bar.
        trials: What must be run.
        judge: From the trials' results.
    """

    group: str
    what: str
    trials: Sequence[Trial]
    judge: Callable[[Results], Verdict]

    def row(self, results: Results) -> Row:
        """The verdict as a plain row; one that could not be measured is neither met nor missed."""
        row: Row = {"group": self.group, "what": self.what}
        try:
            verdict = self.judge(results)
        except NotMeasured as problem:
            return row | {"measured": "not measured", "is_met": None, "ratio": None, "note": str(problem)[:300]}
        ratio = None if verdict.ratio != verdict.ratio else verdict.ratio
        return row | {
            "measured": verdict.measured,
            "is_met": bool(verdict.is_met),
            "ratio": ratio,
            "note": verdict.note,
        }


def at_most(value: float, limit: float, measured: str, note: str = "") -> Verdict:
    """Met where a value is no more than the limit."""
    return Verdict(measured, value <= limit, value / limit if limit > 0.0 else float("nan"), note)


def none_of(count: int, measured: str, note: str = "") -> Verdict:
    """Met where there are none."""
    return Verdict(measured, count == 0, note=note)

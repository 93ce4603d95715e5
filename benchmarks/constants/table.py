"""The table of what came out when a number was halved and doubled."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from benchmarks.constants.numbers import Number

HEAD = (
    "| number | value | half: right | lost | wrong | time | double: right | lost | wrong | time |\n"
    "|---|---|---|---|---|---|---|---|---|---|"
)


@dataclass(frozen=True)
class Outcome:
    """A run of all recordings.

    Attributes:
        right: Fingertips within the limits.
        tips: Fingertips marked.
        lost: Frames called lost.
        wrong: Frames called `ok` with a fingertip in a wrong place.
        seconds: Of the processor.
        tracks: Digests of the tracks, which tell whether anything changed at all.
        failed: What the run said when it ended; empty where it came through.
    """

    right: int = 0
    tips: int = 0
    lost: int = 0
    wrong: int = 0
    seconds: float = 0.0
    tracks: tuple[str, ...] = ()
    failed: str = ""

    @classmethod
    def load(cls, path: Path) -> Outcome:
        told = json.loads(path.read_text())
        if isinstance(told, str):
            return cls(failed=told)
        right, tips, lost, wrong = (sum(one[name] for one in told) for name in ("right", "tips", "lost", "wrong"))
        return cls(right, tips, lost, wrong, sum(one["seconds"] for one in told), tuple(one["track"] for one in told))

    def is_same(self, other: Outcome) -> bool:
        return not self.failed and self.tracks == other.tracks

    def cells(self, usual: Outcome) -> str:
        """Differences from the usual run, or `same` where every pose is the same to the last bit."""
        if self.failed:
            return "fails | | | "
        time = f"{self.seconds / usual.seconds:.2f}"
        if self.is_same(usual):
            return f"same | | | {time}"
        return f"{self.right - usual.right:+d} | {self.lost - usual.lost:+d} | {self.wrong - usual.wrong:+d} | {time}"


def write_table(numbers: list[Number], usual: Outcome, found: dict[tuple[Number, float], Outcome]) -> str:
    """A row for each number; `found` holds those that were changed, by factor."""
    rows = [HEAD]
    for one in numbers:
        head = f"| {one.module.removeprefix('tracker.')}.{one.name} | {one.value:g} |"
        if (one, 0.5) in found:
            rows.append(f"{head} {found[one, 0.5].cells(usual)} | {found[one, 2.0].cells(usual)} |")
        else:
            rows.append(f"{head} {'kernel' if one.is_compiled else 'not read'} | | | | | | | |")
    return "\n".join(rows)

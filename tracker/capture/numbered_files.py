"""Files that differ only in a number, such as `depth_031.png` ... `depth_230.png`."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

_LAST_NUMBER = re.compile(r"(.*?)([0-9]{1,18})([^0-9/]*)", re.DOTALL)
_FIELD = re.compile(r"\*|\{[^{}/]*\}|%0?[0-9]*d|#+")


@dataclass(frozen=True)
class NumberedFiles:
    """A series of files in the order of their numbers.

    Attributes:
        pattern: Their common name, with `*` for the number.
        numbers: Ascending.
        names: Relative name for each number.
        doubles: Names whose number another file has too (`1.png` and `01.png`).
    """

    pattern: str
    numbers: tuple[int, ...]
    names: tuple[str, ...]
    doubles: tuple[str, ...] = ()

    @property
    def step(self) -> int:
        """The usual distance of two numbers."""
        distances = Counter(b - a for a, b in zip(self.numbers, self.numbers[1:], strict=False))
        return min(distances, key=lambda d: (-distances[d], d)) if distances else 1

    def find_gaps(self) -> list[tuple[int, int, int]]:
        """Where numbers are missing: (number before, number after, how many frames)."""
        step = self.step
        return [
            (a, b, max(1, round((b - a) / step) - 1))
            for a, b in zip(self.numbers, self.numbers[1:], strict=False)
            if b - a != step
        ]


def group_by_number(names: Iterable[str], suffixes: tuple[str, ...]) -> list[NumberedFiles]:
    """All series among the files of these types, largest first; the number is the last one in the file's name."""
    groups: dict[str, list[tuple[int, str]]] = defaultdict(list)
    for name in names:
        folder, slash, base = name.rpartition("/")
        stem, dot, suffix = base.rpartition(".")
        if dot + suffix.lower() not in suffixes:
            continue
        match = _LAST_NUMBER.fullmatch(stem)
        if match is not None:
            groups[f"{folder}{slash}{match[1]}*{match[3]}.{suffix}"].append((int(match[2]), name))
    series = [_make_series(pattern, entries) for pattern, entries in groups.items()]
    return sorted(series, key=lambda s: (-len(s.numbers), s.pattern))


def match_pattern(names: Iterable[str], pattern: str) -> NumberedFiles | None:
    """The files that a pattern names, its one number written `*`, `{:03d}`, `%03d` or `###`; None if it has none."""
    fields = list(_FIELD.finditer(pattern))
    if len(fields) != 1:
        return None
    start, end = fields[0].span()
    expression = re.compile(re.escape(pattern[:start]) + "([0-9]{1,18})" + re.escape(pattern[end:]))
    entries = [(int(match[1]), name) for name in names if (match := expression.fullmatch(name))]
    return _make_series(pattern, entries)


def _make_series(pattern: str, entries: list[tuple[int, str]]) -> NumberedFiles:
    entries = sorted(entries)
    kept: list[tuple[int, str]] = []
    doubles: list[str] = []
    for number, name in entries:
        if kept and kept[-1][0] == number:
            doubles.append(name)
        else:
            kept.append((number, name))
    return NumberedFiles(pattern, tuple(n for n, _ in kept), tuple(name for _, name in kept), tuple(doubles))


def sort_naturally(names: Iterable[str]) -> list[str]:
    """Names in the order a person expects: `cam2` before `cam10`."""
    return sorted(
        names, key=lambda name: [(int(p), "") if p.isdigit() else (-1, p) for p in re.split(r"([0-9]+)", name)]
    )

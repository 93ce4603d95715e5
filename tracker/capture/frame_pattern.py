"""Where the image of a frame lies: a relative path with one frame number in it."""

from __future__ import annotations

import re
from dataclasses import dataclass

from tracker.capture.relative_path import find_path_fault

_PATTERN = re.compile(r"([^{}]*)\{:(?:0([1-9]|1[0-9]))?d\}([^{}]*)")


@dataclass(frozen=True)
class FramePattern:
    """A path such as `color/{:06d}.png`; foreign text never reaches `str.format`.

    Attributes:
        head: Before the number.
        digits: Least number of digits, 0 for no padding.
        tail: After the number.
    """

    head: str
    digits: int
    tail: str

    def __str__(self) -> str:
        return f"{self.head}{{:{f'0{self.digits}' if self.digits else ''}d}}{self.tail}"

    def path(self, index: int) -> str:
        """Relative path of frame `index`."""
        assert index >= 0
        return f"{self.head}{index:0{self.digits}d}{self.tail}" if self.digits else f"{self.head}{index}{self.tail}"

    @property
    def suffix(self) -> str:
        """File type with its dot, lower case, such as `.png`."""
        dot = self.tail.rfind(".")
        return self.tail[dot:].lower() if dot >= 0 and "/" not in self.tail[dot:] else ""


def find_pattern_fault(text: str, suffixes: tuple[str, ...]) -> str:
    """What is wrong with a frame pattern from outside; empty when nothing is."""
    match = _PATTERN.fullmatch(text)
    if match is None:
        return "needs exactly one frame number, written like {:06d}"
    pattern = parse_pattern(text)
    fault = find_path_fault(pattern.path(0)) or find_path_fault(pattern.path(10**9))
    if fault:
        return fault
    if pattern.suffix not in suffixes:
        return f"names no file of type {' or '.join(suffixes)}"
    return ""


def parse_pattern(text: str) -> FramePattern:
    """The pattern in a text that `find_pattern_fault` has accepted (or that we wrote)."""
    match = _PATTERN.fullmatch(text)
    assert match is not None, text
    return FramePattern(match[1], int(match[2] or 0), match[3])

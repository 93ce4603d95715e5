"""One panel of a plot: its scales, ticks and frame, in SVG."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape

FONT = 12
"""px; a character is taken to be as wide as 0.56 of it."""


def width_of(text: str) -> float:
    """About how wide a text is, px."""
    return 0.56 * FONT * len(text)


def find_ticks(low: float, high: float, wanted: int = 5) -> list[float]:
    """Round numbers that cover a range, about so many."""
    assert math.isfinite(low) and math.isfinite(high)
    if high <= low:
        high = low + max(abs(low), 1.0)
    rough = (high - low) / wanted
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(m * power for m in (1.0, 2.0, 2.5, 5.0, 10.0) if m * power >= rough * (1.0 - 1e-9))
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [round(n * step, 12) for n in range(first, last + 1)]


def wrap(text: str, room: float) -> list[str]:
    """A text in lines of whole words no wider than `room`, px."""
    lines: list[str] = []
    for word in text.split():
        if lines and width_of(f"{lines[-1]} {word}") <= room:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return lines


def show_number(value: float) -> str:
    """A tick's label."""
    return f"{value:.6g}"


@dataclass(frozen=True)
class Axes:
    """A panel's place on the sheet and its scales.

    Attributes:
        left, top, width, height: Of the field, px of the sheet.
        x_range, y_range: What its edges stand for.
    """

    left: float
    top: float
    width: float
    height: float
    x_range: tuple[float, float]
    y_range: tuple[float, float]

    def x(self, value: float) -> float:
        low, high = self.x_range
        return self.left + self.width * (value - low) / (high - low)

    def y(self, value: float) -> float:
        low, high = self.y_range
        return self.top + self.height * (1.0 - (value - low) / (high - low))

    def frame(self, title: str, x_label: str, y_label: str, y_ticks: list[float]) -> list[str]:
        """Title, axis names, horizontal grid and its labels."""
        middle, bottom = self.left + self.width / 2, self.top + self.height
        parts = [f'<text class="title" x="{self.left:.1f}" y="{self.top - 14:.1f}">{escape(title)}</text>']
        for tick in y_ticks:
            y = self.y(tick)
            parts.append(f'<path class="grid" d="M{self.left:.1f} {y:.1f}h{self.width:.1f}"/>')
            parts.append(
                f'<text x="{self.left - 7:.1f}" y="{y + 4:.1f}" text-anchor="end">{escape(show_number(tick))}</text>'
            )
        parts.append(f'<text x="{middle:.1f}" y="{bottom + 36:.1f}" text-anchor="middle">{escape(x_label)}</text>')
        y = self.top + self.height / 2
        x = self.left - 40
        parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="middle" transform="rotate(-90 {x:.1f} {y:.1f})">'
            f"{escape(y_label)}</text>"
        )
        return parts

    def x_tick(self, value: float, label: str, room: float = math.inf) -> str:
        """A mark and its label under the field, in lines no wider than `room`, px, where words allow."""
        bottom, x = self.top + self.height, self.x(value)
        lines = "".join(
            f'<text x="{x:.1f}" y="{bottom + 18 + 14 * number:.1f}" text-anchor="middle">{escape(line)}</text>'
            for number, line in enumerate(wrap(label, room))
        )
        return f'<path class="axis" d="M{x:.1f} {bottom:.1f}v4"/>{lines}'

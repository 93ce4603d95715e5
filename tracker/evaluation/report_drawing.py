"""Drawings of a report: curves as inline SVG, bars behind numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from math import inf
from typing import Any

COLORS = ("#1c9c8f", "#d9822b", "#7d6bd8", "#3d86d8", "#c2547e", "#7c8a2e", "#8a8f98", "#b0553a")
DASHES = ("", "7 4", "2 3", "9 3 2 3", "4 2", "12 4", "1 4", "6 2 1 2")
WIDTH, HEIGHT = 960, 240
"""px of a drawing; below, the room around its axes."""
LEFT, RIGHT, TOP, BOTTOM = 48, 12, 10, 34


@dataclass(frozen=True)
class Line:
    """A curve; both lists have one length, None is a gap."""

    label: str
    x: Sequence[float]
    y: Sequence[float | None]
    reach: float = inf
    """Values that are farther apart in x are not joined: between them nothing was measured."""

    @classmethod
    def by_components(cls, label: str, rows: Sequence[Mapping[str, Any]]) -> Line:
        """Mean errors, mm, over the number of components, as a study writes its rows."""
        return cls(label, [row["components"] for row in rows], [row["mean_mm"] for row in rows])

    def pieces(self) -> list[list[tuple[float, float]]]:
        """What is drawn without a break."""
        found: list[list[tuple[float, float]]] = []
        is_joined = False
        for x, y in zip(self.x, self.y, strict=True):
            if y is None:
                is_joined = False
                continue
            if is_joined and x - found[-1][-1][0] <= self.reach:
                found[-1].append((x, y))
            else:
                found.append([(x, y)])
            is_joined = True
        return found


@dataclass(frozen=True)
class _Plane:
    """What is drawn from left to right, and from 0 up to the top."""

    low: float
    high: float
    top: float

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Place in the drawing, px."""
        across = (x - self.low) / (self.high - self.low)
        return LEFT + across * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - y / self.top * (HEIGHT - TOP - BOTTOM)

    def draw_grid(self) -> str:
        parts = []
        for step in range(5):
            value = self.top * step / 4
            y = self.at(self.low, value)[1]
            parts.append(f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>')
            parts.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{value:.3g}</text>')
        for step in range(6):
            value = self.low + (self.high - self.low) * step / 5
            x = self.at(value, 0)[0]
            anchor = "end" if step == 5 else "middle"
            parts.append(f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 15}" text-anchor="{anchor}">{value:.4g}</text>')
        return "".join(parts)

    def draw(self, line: Line, color: str, dash: str) -> str:
        """Its pieces; dots where there are few values, and where one stands alone."""
        pieces = [[self.at(x, min(y, self.top)) for x, y in piece] for piece in line.pieces()]
        paths = [" ".join(f"{x:.1f},{y:.1f}" for x, y in piece) for piece in pieces]
        dotted = pieces if sum(map(len, pieces)) <= 60 else [piece for piece in pieces if len(piece) == 1]
        return "".join(
            [
                *(f'<polyline points="{path}" stroke="{color}" stroke-dasharray="{dash}"/>' for path in paths),
                *(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2" fill="{color}"/>' for piece in dotted for x, y in piece),
            ]
        )


def draw_curves(lines: Sequence[Line], label: str, x_title: str, y_title: str, top: float | None = None) -> str:
    """Lines over one another, told apart by colour and dashes, with a legend."""
    xs = [value for line in lines for value in line.x]
    ys = [value for line in lines for value in line.y if value is not None]
    if not xs or not ys:
        return "<p class=quiet>Nothing to draw.</p>"
    plane = _Plane(min(xs), max(max(xs), min(xs) + 1), top or max(1e-9, 1.05 * max(ys)))
    looks = [(line, COLORS[n % len(COLORS)], DASHES[n % len(DASHES)]) for n, line in enumerate(lines)]
    curves = "".join(plane.draw(line, color, dash) for line, color, dash in looks)
    legend = "".join(
        f'<span><svg class="key" viewBox="0 0 24 8"><line x1="0" x2="24" y1="4" y2="4" '
        f'stroke="{color}" stroke-dasharray="{dash}"/></svg>{escape(line.label)}</span>'
        for line, color, dash in looks
    )
    return (
        f'<figure><svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(label)}">{plane.draw_grid()}'
        f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 4}" text-anchor="end">{escape(x_title)}</text>'
        f'<text x="4" y="{HEIGHT - 4}">{escape(y_title)}</text>{curves}</svg>'
        f'<figcaption class="legend">{legend}</figcaption></figure>'
    )


def draw_bar_cell(value: float | None, full: float, text: str | None = None, best: bool = False) -> str:
    """A table cell with a number and a bar that is as long as the value's share of `full`."""
    if value is None:
        return "<td class=number>–</td>"
    share = 100 * min(1.0, max(0.0, value / full)) if full > 0 else 0.0
    shown = text if text is not None else f"{value:.2f}"
    mark = ' class="best" title="the smallest of its column"' if best else ""
    return f'<td class="number bar" style="--share:{share:.1f}%"><span{mark}>{escape(shown)}</span></td>'

"""Plots as SVG that stand alone, in light and dark: lines, and bars side by side."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape

from benchmarks.studies.axes import Axes, find_ticks, show_number, width_of

SHEET = 760.0
"""px, the width of every plot."""

FIELD = 210.0
"""px, the height of a panel's field."""

STYLE = """
.plot{--paper:#fff;--ink:#1b2330;--mute:#5b6676;--grid:#e3e7ed;
--c0:#1f66c7;--c1:#c9651b;--c2:#23875f;--c3:#7d4fc4;--c4:#b3375e;--c5:#8a6d1a;--ref:#8b95a5}
@media(prefers-color-scheme:dark){.plot{--paper:#14181f;--ink:#e8ecf2;--mute:#9aa6b6;--grid:#2a313c;
--c0:#6aa5f5;--c1:#f0a15e;--c2:#58c497;--c3:#b596f0;--c4:#ef7f9f;--c5:#d8bb5c;--ref:#7a8597}}
.plot .sheet{fill:var(--paper)}.plot text{font:12px system-ui,-apple-system,"Segoe UI",sans-serif;fill:var(--mute)}
.plot .title{font-weight:600;fill:var(--ink)}.plot .value{font-size:11px;fill:var(--ink)}
.plot .grid{stroke:var(--grid)}.plot .axis{stroke:var(--mute)}.plot .line{fill:none;stroke-width:2}
.plot .t16{stroke-dasharray:5 4}
"""


@dataclass(frozen=True)
class Series:
    """Points joined by a line; NaN leaves a gap. `is_paper` draws it dashed and grey, as T16's numbers are."""

    name: str
    x: Sequence[float]
    y: Sequence[float]
    is_paper: bool = False
    has_marks: bool = True


@dataclass(frozen=True)
class Lines:
    """A panel of lines; `from_zero` puts zero on the y axis, `even` sets the x values at equal distances."""

    title: str
    x_label: str
    y_label: str
    series: Sequence[Series]
    from_zero: bool = True
    even: bool = False
    y_top: float | None = None


@dataclass(frozen=True)
class Bars:
    """A panel of bars: one group for each label, one bar in it for each name. A missing value is NaN."""

    title: str
    y_label: str
    labels: Sequence[str]
    values: Mapping[str, Sequence[float]]
    paper: Sequence[str] = ()
    """Names that hold T16's numbers."""


def draw_plot(panels: Sequence[Lines | Bars], describe: str) -> str:
    """Panels side by side with one legend; `describe` is what a screen reader says."""
    names: dict[str, bool] = {}
    for panel in panels:
        if isinstance(panel, Lines):
            names |= {series.name: series.is_paper for series in panel.series}
        else:
            names |= {name: name in panel.paper for name in panel.values}
    colors: dict[str, str] = {}
    for name, is_paper in names.items():
        colors[name] = "var(--ref)" if is_paper else f"var(--c{sum(c != 'var(--ref)' for c in colors.values()) % 6})"
    legend, top = _legend(names, colors)
    each = SHEET / len(panels)
    parts = []
    for number, panel in enumerate(panels):
        field = (each * number + 62.0, top + 34.0, each - 78.0, FIELD)
        parts += _lines(panel, field, colors) if isinstance(panel, Lines) else _bars(panel, field, colors)
    height = top + 34.0 + FIELD + 50.0
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="plot" viewBox="0 0 {SHEET:.0f} {height:.0f}" '
        f'width="{SHEET:.0f}" height="{height:.0f}" role="img" aria-label="{escape(describe, quote=True)}">'
        f"<style>{STYLE}</style>"
        f'<rect class="sheet" width="100%" height="100%" rx="6"/>{"".join(legend)}{"".join(parts)}</svg>\n'
    )


def _legend(names: dict[str, bool], colors: dict[str, str]) -> tuple[list[str], float]:
    """Its entries, in as many lines as they need, and where the panels may begin, px."""
    if len(names) < 2:
        return [], 4.0
    parts, x, y = [], 16.0, 20.0
    for name, is_paper in names.items():
        room = 32.0 + width_of(name) + 18.0
        if x + room > SHEET and x > 16.0:
            x, y = 16.0, y + 18.0
        kind = "line t16" if is_paper else "line"
        parts.append(f'<path class="{kind}" style="stroke:{colors[name]}" d="M{x:.0f} {y - 4:.0f}h22"/>')
        parts.append(f'<text x="{x + 28:.0f}" y="{y:.0f}">{escape(name)}</text>')
        x += room
    return parts, y + 6.0


def _lines(panel: Lines, field: tuple[float, float, float, float], colors: dict[str, str]) -> list[str]:
    values = sorted({float(x) for series in panel.series for x in series.x})
    place = {value: float(n) if panel.even else value for n, value in enumerate(values)}
    known = [float(y) for series in panel.series for y in series.y if math.isfinite(y)] or [0.0, 1.0]
    ticks = find_ticks(0.0 if panel.from_zero else min(known), panel.y_top or max(known))
    low, high = place[values[0]], place[values[-1]]
    margin = 0.03 * (high - low) or 1.0
    axes = Axes(*field, (low - margin, high + margin), (ticks[0], ticks[-1]))
    parts = axes.frame(panel.title, panel.x_label, panel.y_label, ticks)
    marks = values if panel.even or len(values) <= 8 else [t for t in find_ticks(low, high) if low <= t <= high]
    parts += [axes.x_tick(place.get(value, value), show_number(value)) for value in marks]
    for series in panel.series:
        color, kind = colors[series.name], "line t16" if series.is_paper else "line"
        points = [(axes.x(place[float(x)]), axes.y(y), y) for x, y in zip(series.x, series.y, strict=True)]
        path, pen_up = "", True
        for x, y, value in points:
            if not math.isfinite(value):
                pen_up = True
                continue
            path += f"{'M' if pen_up else 'L'}{x:.1f} {y:.1f}"
            pen_up = False
        parts.append(f'<path class="{kind}" style="stroke:{color}" d="{path}"/>')
        if series.has_marks:
            parts += [
                f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" style="fill:{color}"><title>{escape(series.name)}: '
                f"{show_number(value)}</title></circle>"
                for x, y, value in points
                if math.isfinite(value)
            ]
    return parts


def _bars(panel: Bars, field: tuple[float, float, float, float], colors: dict[str, str]) -> list[str]:
    known = [float(v) for values in panel.values.values() for v in values if math.isfinite(v)] or [1.0]
    ticks = find_ticks(0.0, 1.05 * max(known))
    axes = Axes(*field, (-0.5, len(panel.labels) - 0.5), (0.0, ticks[-1]))
    parts = axes.frame(panel.title, "", panel.y_label, ticks)
    room = axes.width / len(panel.labels)
    parts += [axes.x_tick(number, label, room) for number, label in enumerate(panel.labels)]
    width = 0.76 / len(panel.values)
    for column, (name, values) in enumerate(panel.values.items()):
        for number, value in enumerate(values):
            if not math.isfinite(value):
                continue
            left, right = (axes.x(number - 0.38 + width * c) for c in (column, column + 0.92))
            y, bottom = axes.y(value), axes.y(0.0)
            parts.append(
                f'<rect x="{left:.1f}" y="{y:.1f}" width="{right - left:.1f}" height="{bottom - y:.1f}" rx="1.5" '
                f'style="fill:{colors[name]}"><title>{escape(name)}: {show_number(value)}</title></rect>'
            )
            if right - left > 20.0:
                label = f"{value:.2f}" if value < 100 else f"{value:.0f}"
                parts.append(
                    f'<text class="value" x="{(left + right) / 2:.1f}" y="{y - 4:.1f}" '
                    f'text-anchor="middle">{label}</text>'
                )
    return parts

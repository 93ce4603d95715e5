"""Bars of the project at a glance: what was measured as a share of what is allowed."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from benchmarks.studies.axes import width_of
from benchmarks.studies.plots import SHEET, STYLE

LABELS = 490.0
"""px, the room of the labels."""

LINE = 21.0
WIDEST = 1.5
"""Shares above are cut there, with an arrow."""


def draw_ratios(items: Sequence[tuple[str, float]], describe: str) -> str:
    """A line for each label and share; a share above one is missed and drawn in another colour."""
    room, top = SHEET - LABELS - 70.0, 26.0
    height = top + LINE * len(items) + 14.0
    one = LABELS + room / WIDEST
    parts = [
        f'<text x="{one:.0f}" y="16" text-anchor="middle">the bar</text>',
        f'<path class="axis" style="stroke-dasharray:3 3" d="M{one:.0f} {top - 4:.0f}V{height - 8:.0f}"/>',
    ]
    for number, (label, ratio) in enumerate(items):
        y = top + LINE * number
        width = max(1.5, room * min(ratio, WIDEST) / WIDEST)
        color = "var(--c2)" if ratio <= 1.0 else "var(--c4)"
        words = f"{100.0 * ratio:.0f} %{'' if ratio <= WIDEST else ' →'}"
        parts.append(
            f'<text x="{LABELS - 8:.0f}" y="{y + 13:.0f}" text-anchor="end">{escape(_cut(label))}</text>'
            f'<rect x="{LABELS:.0f}" y="{y + 3:.0f}" width="{width:.1f}" height="{LINE - 8:.0f}" rx="1.5" '
            f'style="fill:{color}"><title>{escape(label)}: {words}</title></rect>'
            f'<text class="value" x="{LABELS + width + 6:.1f}" y="{y + 13:.0f}">{words}</text>'
        )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="plot" viewBox="0 0 {SHEET:.0f} {height:.0f}" '
        f'width="{SHEET:.0f}" height="{height:.0f}" role="img" aria-label="{escape(describe, quote=True)}">'
        f'<style>{STYLE}</style><rect class="sheet" width="100%" height="100%" rx="6"/>{"".join(parts)}</svg>\n'
    )


def _cut(label: str) -> str:
    """What there is room for."""
    while width_of(label) > LABELS - 20.0:
        label = label[:-2].rstrip(" ,…") + "…"
    return label

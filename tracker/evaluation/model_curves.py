"""Curves of a model study, [R17] Fig. 12-14, as drawings that stand alone."""

from __future__ import annotations

from typing import Any

from tracker.evaluation.model_report_html import MOST_COMPONENTS
from tracker.evaluation.report_drawing import Line, draw_curves


def draw_study(study: dict[str, Any]) -> dict[str, str]:
    """SVG documents by name, of those of `compactness`, `pose_space`, `mirrored` and `shape_space` that are there."""
    drawings = {}
    if "compactness" in study:
        lines = [
            Line(f"{name} space", list(range(1, len(shares) + 1)), [100 * share for share in shares])
            for name, shares in ((n, s[:MOST_COMPONENTS]) for n, s in study["compactness"].items())
        ]
        drawings["compactness"] = draw_curves(lines, "Compactness", "components", "variance explained, %", 100.0)
    curves = {
        "pose_space": (study.get("pose_space"), "scan to mesh, mm"),
        "shape_space": (study.get("shape_space"), "template, mean absolute, mm"),
    }
    for name, (rows, title) in curves.items():
        if rows:
            drawings[name] = draw_curves(
                [Line.by_components(label, found) for label, found in rows.items()], title, "components", title
            )
    return {name: make_svg(figure) for name, figure in drawings.items()}


def make_svg(figure: str) -> str:
    """The drawing of a report's figure as a file of its own, its legend below it."""
    from html import unescape
    from re import findall, search

    from tracker.evaluation.report_drawing import HEIGHT, WIDTH

    inner = search(r"<svg[^>]*>(.*?)</svg>", figure, flags=16)
    assert inner is not None, "a figure has a drawing"
    keys = findall(r'stroke="(#\w+)" stroke-dasharray="([^"]*)"/></svg>(.*?)</span>', figure)
    legend = []
    for place, (color, dash, label) in enumerate(keys):
        x = 48 + 300 * (place % 3)
        y = HEIGHT + 16 + 18 * (place // 3)
        legend.append(
            f'<line x1="{x}" x2="{x + 24}" y1="{y - 4}" y2="{y - 4}" stroke="{color}" stroke-width="2" '
            f'stroke-dasharray="{dash}"/><text x="{x + 32}" y="{y}">{label}</text>'
        )
    height = HEIGHT + 28 + 18 * ((len(keys) - 1) // 3 if keys else 0)
    assert unescape(inner.group(1))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}">'
        "<style>text{font:11px system-ui,sans-serif;fill:#565d68}.grid{stroke:#dcdfe4}"
        "polyline{fill:none;stroke-width:1.6}</style>"
        f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>{inner.group(1)}{"".join(legend)}</svg>\n'
    )

"""A report as one file that anybody can open: nothing is fetched, nothing runs."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from tracker.evaluation.report_style import STYLE

POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


def write_page(title: str, parts: Sequence[str]) -> str:
    """The whole file; `parts` are HTML."""
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{STYLE}</style></head>'
        f"<body><h1>{escape(title)}</h1>{''.join(parts)}</body></html>\n"
    )


def write_table(head: Sequence[str], rows: Sequence[str]) -> str:
    """A table; `rows` are HTML."""
    cells = "".join(f"<th{' class=number' if place else ''}>{escape(cell)}</th>" for place, cell in enumerate(head))
    return f"<div class=scroll><table><thead><tr>{cells}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"


def write_row(name: str, cells: Sequence[str]) -> str:
    """A row; `cells` are HTML."""
    return f"<tr><th scope=row>{escape(name)}</th>{''.join(cells)}</tr>"

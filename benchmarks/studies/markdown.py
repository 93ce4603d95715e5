"""The report in Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.studies.blocks import Block, Picture, Section, Table, Text

PICTURES = "studies"
"""Folder of the plots, beside the page."""


def write_markdown(title: str, preface: Sequence[str], sections: Sequence[Section]) -> str:
    """The page; plots are named, not contained."""
    lines = [f"# {title}", ""]
    for paragraph in preface:
        lines += [paragraph, ""]
    for section in sections:
        lines += [f"## {section.title}", "", f"*{section.paper}.* {section.question}", ""]
        if section.same:
            lines += [f"- **The same:** {section.same}", f"- **Not comparable:** {section.differs}", ""]
        for block in section.blocks:
            lines += [*_block(block), ""]
    return "\n".join(lines).rstrip() + "\n"


def _block(block: Block) -> list[str]:
    match block:
        case Text(text):
            return [text]
        case Picture(name, _, caption):
            return [f"![{caption}]({PICTURES}/{name}.svg)", "", f"*{caption}*"]
        case Table(columns, rows, caption):
            lines = [_row(columns), "|" + "---|" * len(columns)]
            lines += [_row(tuple(cell or "-" for cell in row)) for row in rows]
            return [*lines, "", f"*{caption}*"] if caption else lines


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

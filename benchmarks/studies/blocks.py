"""What a report is made of, whatever it is written in."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Text:
    """A paragraph; `code`, **bold** and [links](x) as in Markdown."""

    text: str


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes:
        columns: Headings; those that begin with "T16" hold the paper's numbers and are set apart.
        rows: Cells as they are shown; an empty one is a dash. A row whose first cell is **bold** is set apart.
        caption: Below it.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""

    def __post_init__(self) -> None:
        assert all(len(row) == len(self.columns) for row in self.rows), "a cell for each column"


@dataclass(frozen=True)
class Picture:
    """A plot.

    Attributes:
        name: Of its file, without ending.
        svg: The drawing.
        caption: Below it.
    """

    name: str
    svg: str
    caption: str


Block = Text | Table | Picture


@dataclass(frozen=True)
class Section:
    """A study in the report.

    Attributes:
        name: Its anchor.
        title: Heading.
        paper: What of T16 it stands beside.
        question: What it asks.
        same: In what it is comparable.
        differs: In what it is not.
        blocks: What was found.
    """

    name: str
    title: str
    paper: str
    question: str
    same: str
    differs: str
    blocks: tuple[Block, ...]

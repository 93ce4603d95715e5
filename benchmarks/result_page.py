"""Pages of `benchmarks/results`: what a benchmark measured, with the command that measures it again."""

from __future__ import annotations

from datetime import date
from pathlib import Path

from tracker.capture.atomic_file import write_atomically

RESULTS = Path(__file__).resolve().parent / "results"


def write_result(
    name: str, title: str, command: str, text: str, folder: Path = RESULTS, day: date | None = None
) -> Path:
    """Write a page whole, or leave the one that is there.

    Args:
        name: Of the file, without its ending.
        title: The page's heading.
        command: What makes the page again.
        text: The figures, in Markdown.
        folder: Where pages lie.
        day: When it was measured; today when left out.

    Returns:
        The page.
    """
    page = folder / f"{name}.md"
    measured = f"Measured on {day or date.today()}."
    write_atomically(page, f"# {title}\n\n    {command}\n\n{measured}\n\n{text.strip()}\n".encode())
    return page

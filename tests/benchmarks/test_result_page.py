"""A page of results is written whole, with its command."""

from __future__ import annotations

from datetime import date
from pathlib import Path

from benchmarks.result_page import write_result


def test_a_page_has_heading_command_day_and_figures(tmp_path: Path) -> None:
    write_result("one", "One", "python -m benchmarks.one --write", "| a |\n|---|\n| 1 |", tmp_path, date(2026, 1, 1))
    page = write_result(
        "one", "One", "python -m benchmarks.one --write", "\n| a |\n|---|\n| 2 |\n", tmp_path, date(2026, 1, 2)
    )
    assert page == tmp_path / "one.md" and list(tmp_path.iterdir()) == [page]
    assert (
        page.read_text()
        == "# One\n\n    python -m benchmarks.one --write\n\nMeasured on 2026-01-02.\n\n| a |\n|---|\n| 2 |\n"
    )

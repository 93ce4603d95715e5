"""The progress line speaks seldom where nobody can watch it move."""

from __future__ import annotations

import io

from tracker.cli.progress import ProgressLine


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_in_a_log_it_says_something_every_tenth_of_the_way():
    stream = io.StringIO()
    line = ProgressLine("rendering", stream)
    for step in range(1001):
        line.show(step / 1000)
    lines = stream.getvalue().splitlines()
    assert len(lines) == 11
    assert lines[-1] == "rendering: 100 %"


def test_on_a_terminal_it_rewrites_its_line_and_ends_it_once():
    stream = Terminal()
    line = ProgressLine("rendering", stream)
    for step in range(11):
        line.show(step / 10, f"frame {step}")
    assert stream.getvalue().count("\n") == 1
    assert stream.getvalue().endswith("rendering: 100 %, frame 10\n")

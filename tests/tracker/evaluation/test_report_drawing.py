"""Curves of a report show what was measured, and nothing between."""

from __future__ import annotations

import re

from tracker.evaluation.report_drawing import Line, draw_curves


def test_frames_that_nobody_labelled_are_not_drawn_across() -> None:
    drawn = draw_curves([Line("a", [0, 1, 2, 42, 43, 90], [1, 2, 3, 4, 5, 6], reach=1)], "error", "frame", "px")
    pieces = [points.split() for points in re.findall(r'<polyline points="([^"]*)"', drawn)]
    assert [len(piece) for piece in pieces] == [3, 2, 1]
    assert drawn.count("<circle") == 6


def test_a_frame_without_a_value_breaks_the_line() -> None:
    drawn = draw_curves([Line("a", [0, 1, 2, 3], [1, None, 3, 4])], "error", "frame", "px")
    pieces = [points.split() for points in re.findall(r'<polyline points="([^"]*)"', drawn)]
    assert [len(piece) for piece in pieces] == [1, 2]


def test_a_value_alone_has_a_dot_where_others_have_none() -> None:
    frames = [*range(100), 200]
    drawn = draw_curves([Line("a", frames, [1.0] * 101, reach=1)], "error", "frame", "px")
    assert drawn.count("<circle") == 1

"""Colours of errors are the same in reports as in the browser."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tracker.evaluation.error_color import ANCHORS, compute_error_color

ROOT = Path(__file__).parents[3]


def test_the_browser_has_the_same_colours() -> None:
    text = (ROOT / "web/src/model/errorColor.ts").read_text()
    theirs = [[int(value) for value in row] for row in re.findall(r"^  \[(\d+), (\d+), (\d+)\],$", text, re.MULTILINE)]
    assert theirs == ANCHORS.astype(int).tolist()


@given(st.integers(0, len(ANCHORS) - 1))
def test_the_anchors_lie_at_equal_steps(number: int) -> None:
    assert compute_error_color(number / (len(ANCHORS) - 1)) == tuple(ANCHORS[number].astype(int))


@given(st.floats(0, 1), st.floats(-0.01, 0.01))
def test_errors_that_are_nearly_the_same_have_nearly_the_same_colour(value: float, step: float) -> None:
    one, other = (np.array(compute_error_color(v)) for v in (value, value + step))
    assert np.abs(one - other).max() <= 0.01 * 4 * np.abs(np.diff(ANCHORS, axis=0)).max() + 1


def test_what_is_beyond_the_scale_or_not_known_is_as_its_end() -> None:
    worst = compute_error_color(1.0)
    assert compute_error_color(7.0) == compute_error_color(float("nan")) == worst
    assert compute_error_color(-1.0) == compute_error_color(0.0)

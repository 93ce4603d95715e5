"""Paths with a frame's number in them: read back as they were written, and never out of their folder."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.frame_pattern import FramePattern, find_pattern_fault, parse_pattern

PLAIN = st.text(st.characters(codec="ascii", exclude_characters="{}"), max_size=8)


@given(PLAIN, st.integers(0, 19), PLAIN, st.integers(0, 10**9))
def test_a_pattern_is_what_its_text_says(head: str, digits: int, tail: str, frame: int) -> None:
    pattern = FramePattern(head, digits, tail)
    assert parse_pattern(str(pattern)) == pattern
    number = pattern.path(frame)[len(head) : len(pattern.path(frame)) - len(tail)]
    assert int(number) == frame and len(number) >= digits and pattern.path(frame) == str(pattern).format(frame)


def test_the_type_is_that_of_the_file_and_not_of_its_folder() -> None:
    assert parse_pattern("a.png/{:d}.JPG").suffix == ".jpg"
    assert parse_pattern("a/{:d}.png/b").suffix == parse_pattern("a/{:d}").suffix == ""


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a/0.png", "exactly one frame number"),
        ("a/{:d}{:d}.png", "exactly one frame number"),
        ("a/{}.png", "exactly one frame number"),
        ("a/{0.__class__:d}.png", "exactly one frame number"),
        ("a/{:020d}.png", "exactly one frame number"),
        ("../{:d}.png", "leads out"),
        ("/a/{:d}.png", "absolute"),
        ("a\\{:d}.png", "backslash"),
        ("c:{:d}.png", "colon"),
        ("con{:d}/../a.png", "leads out"),
        ("com{:d}.png", "device"),
        ("com{:06d}.png", ""),
        ("a/{:d}.exe", "no file of type .png or .jpg"),
    ],
)
def test_patterns_from_outside_are_looked_at_before_they_are_used(text: str, told: str) -> None:
    fault = find_pattern_fault(text, (".png", ".jpg"))
    assert told in fault and bool(fault) == bool(told)

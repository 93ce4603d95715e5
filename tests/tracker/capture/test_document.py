"""JSON from outside: each value is of its kind and within its bounds, or the error says where it stands."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.document import Node, load_json, parse_json, read_regular_file
from tracker.errors import SequenceError

ONE = st.one_of(st.none(), st.booleans(), st.integers(-9, 9), st.floats(-9, 9), st.text(max_size=6))
ANYTHING = st.one_of(ONE, st.lists(ONE, max_size=3), st.dictionaries(st.text(max_size=3), ONE, max_size=3))


def node(value: Any) -> Node:
    return Node(value, "a.json", "x", SequenceError)


@given(ANYTHING)
def test_what_json_writes_is_read_again(value: Any) -> None:
    assert parse_json(json.dumps(value).encode(), "a.json", SequenceError).value == value


@given(ANYTHING, st.integers(-5, 5), st.integers(-5, 5))
def test_a_whole_number_is_within_its_bounds_or_refused(value: Any, low: int, high: int) -> None:
    is_one = isinstance(value, int) and not isinstance(value, bool) and low <= value <= high
    if is_one:
        assert node(value).integer(low, high) == value
    else:
        with pytest.raises(SequenceError, match=r"a\.json: x is .*; needed a whole number from"):
            node(value).integer(low, high)


@given(ANYTHING, st.integers(0, 5))
def test_a_text_is_printable_and_not_too_long_or_refused(value: Any, most: int) -> None:
    try:
        text = node(value).text(most)
    except SequenceError:
        is_text = isinstance(value, str) and bool(value.strip()) and len(value) <= most and value.isprintable()
        assert not is_text
    else:
        assert text == value and text.strip() and text.isprintable() and len(text) <= most


@pytest.mark.parametrize(
    ("read", "value", "told"),
    [
        (lambda n: n.number(0, 1), True, "needed a number from 0 to 1"),
        (lambda n: n.number(0, 1), 1.5, "x is 1.5"),
        (lambda n: n.number(0, 1), float("nan"), "x is nan"),
        (lambda n: n.choice("right", "left"), "both", "one of right, left"),
        (lambda n: n.choice("right", "left"), ["right"], "one of right, left"),
        (lambda n: n.members(), [], "an object"),
        (lambda n: n.get("a"), {}, "x has no 'a'"),
        (lambda n: n.get("a").integer(0, 1), {"a": 2}, r"x\.a is 2"),
        (lambda n: list(n.items(2)), {}, "a list"),
        (lambda n: list(n.items(2)), [1, 2, 3], "x has 3 elements; at most 2"),
        (lambda n: n.vector(3), [1, "2"], r"x\[1\] is '2'"),
        (lambda n: n.vector(3, 5.0), [6], "from -5 to 5"),
        (lambda n: n.matrix(2, 2), [[1, 2], [3]], "2 rows of 2 numbers"),
        (lambda n: n.matrix(2, 2), [[1, 2]], "2 rows of 2 numbers"),
    ],
)
def test_a_value_of_another_kind_is_refused_where_it_stands(read: Callable, value: Any, told: str) -> None:
    with pytest.raises(SequenceError, match=told):
        read(node(value))


def test_a_long_value_is_cut_in_the_message() -> None:
    with pytest.raises(SequenceError) as refusal:
        node("x" * 1000).integer(0, 1)
    assert len(str(refusal.value)) < 150


def test_null_is_as_good_as_not_there() -> None:
    assert node({"a": 0}).has("a") and not node({"a": None}).has("a") and not node({}).has("a")


@pytest.mark.parametrize("data", [b"", b"{", b"[NaN]", b"[Infinity]", b"\xff", b"[" * 100_000, b'{"a": 1} x'])
def test_what_is_not_strict_json_is_refused(data: bytes) -> None:
    with pytest.raises(SequenceError, match="needed valid JSON in UTF-8"):
        parse_json(data, "a.json", SequenceError)


def test_only_plain_files_of_a_size_that_was_expected_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b"\xef\xbb\xbf[1]")
    assert load_json(path, 6, SequenceError).value == [1], "with the mark that some editors put before it"
    os.mkfifo(tmp_path / "pipe")
    for name, told in (("b.json", "no such file"), (".", "not a plain file"), ("pipe", "not a plain file")):
        with pytest.raises(SequenceError, match=told):
            read_regular_file(tmp_path / name, 6, SequenceError)
    with pytest.raises(SequenceError, match="has 6 bytes; at most 5"):
        read_regular_file(path, 5, SequenceError)
    with pytest.raises(SequenceError, match="cannot be opened"):
        read_regular_file(tmp_path / "a\0b", 5, SequenceError)

"""Where a joint came from is written with what is known, and read again."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.document import Node
from tracker.capture.joint_source import SOURCE_KINDS, JointSource, parse_source
from tracker.errors import AnnotationError

WORDS = st.one_of(st.just(""), st.from_regex(r"[A-Za-z0-9]{1,20}", fullmatch=True))
SOURCES = st.builds(
    JointSource, st.sampled_from(SOURCE_KINDS), WORDS, st.one_of(st.none(), st.uuids()), WORDS, st.booleans()
)


def parse(value: Any) -> JointSource | None:
    return parse_source(Node(value, "annotations.json", "items[0].sources[3]", AnnotationError))


@given(SOURCES)
def test_a_source_is_read_as_it_was_written(source: JointSource) -> None:
    assert parse(source.to_json()) == source == JointSource.from_json(source.to_json())
    assert "" not in source.to_json().values() and None not in source.to_json().values()


def test_null_is_placed_by_hand() -> None:
    assert parse(None) is None


@pytest.mark.parametrize(
    ("value", "told"),
    [
        ({}, "has no 'kind'"),
        ({"kind": "guess"}, "one of track, fit"),
        ({"kind": "track", "track_id": "7"}, "the id of a track, a UUID"),
        ({"kind": "copy", "is_independent": 1}, "true or false"),
        ({"kind": "track", "label": "x" * 201}, "1 to 200 printable"),
        ("track", "an object"),
    ],
)
def test_an_entry_that_is_no_source_is_refused(value: Any, told: str) -> None:
    with pytest.raises(AnnotationError, match=told):
        parse(value)

"""Revisions in headers: one of our own in quotes, and nothing that could be taken for it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.database.revision import read_if_match, write_etag
from server.errors import InvalidError, PreconditionMissingError


@given(st.integers(0, 999_999_999))
def test_what_is_written_is_read_also_as_a_weak_tag_between_blanks(revision: int) -> None:
    for text in (write_etag(revision), f" W/{write_etag(revision)} "):
        assert read_if_match(text) == revision


@pytest.mark.parametrize("text", ["", "3", '"3', '"-1"', '"1.0"', '"٣"', '"1","2"', "*", '"1234567890"', 'w/"3"', '""'])
def test_anything_else_is_refused_with_what_came(text: str) -> None:
    with pytest.raises(InvalidError, match="If-Match is"):
        read_if_match(text)


def test_a_change_without_a_revision_is_told_to_give_one() -> None:
    with pytest.raises(PreconditionMissingError, match="send If-Match"):
        read_if_match(None)

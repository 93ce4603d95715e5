"""Names that people give: what is taken, and how words are searched for in them."""

from __future__ import annotations

import pytest
from pydantic import TypeAdapter, ValidationError
from sqlalchemy import select

from server.access.models import Account
from server.database import Database
from server.database.texts import Label, Name, Text, Words, match_words


@pytest.mark.parametrize("text", ["Anna", "  Änna Müller  ", "手", "a" * 200])
def test_a_name_is_kept_without_the_spaces_around_it(text: str) -> None:
    assert TypeAdapter(Name).validate_python(text) == text.strip()


@pytest.mark.parametrize("text", ["", "   ", "a" * 201, "a\nb", "a\0b", "a\u202eb", "a\u200b", "a\n"])
def test_a_name_that_is_empty_long_or_hides_something_is_refused(text: str) -> None:
    with pytest.raises(ValidationError, match="1 to 200 printable characters"):
        TypeAdapter(Name).validate_python(text)


def test_a_label_may_be_empty_and_a_text_may_have_lines() -> None:
    assert TypeAdapter(Label).validate_python("") == ""
    assert TypeAdapter(Text).validate_python("one\ntwo") == "one\ntwo"
    with pytest.raises(ValidationError):
        TypeAdapter(Words).validate_python(" \n ")


def test_the_schema_says_what_the_check_asks() -> None:
    schema = TypeAdapter(Name).json_schema()
    assert (schema["minLength"], schema["maxLength"]) == (1, 200) and "pattern" in schema


@pytest.mark.parametrize(
    ("search", "found"),
    [
        (None, ["Left_fist 50%", "left hand", "right hand"]),
        ("HAND left", ["left hand"]),
        ("50%", ["Left_fist 50%"]),
        ("t_f", ["Left_fist 50%"]),
        ("%", ["Left_fist 50%"]),
        ("left right", []),
    ],
)
def test_each_word_must_be_there_and_percent_signs_mean_themselves(database: Database, search, found) -> None:
    with database.writing() as session:
        session.add_all([Account(name=name) for name in ("left hand", "right hand", "Left_fist 50%")])
    with database.reading() as session:
        query = select(Account.name).where(Account.name != "local", *match_words(search, Account.name))
        assert session.scalars(query.order_by(Account.name)).all() == found

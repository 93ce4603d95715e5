"""Names and other short texts that people give, in one way everywhere; the OpenAPI document says the same."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator, WithJsonSchema
from sqlalchemy import ColumnElement, or_
from sqlalchemy.orm import InstrumentedAttribute

_HIDDEN = r"\x00-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\uffff"
"""Control characters, and those that hide others or turn them round."""
LABEL = rf"^[^{_HIDDEN}]*$"
NAME = rf"^[^{_HIDDEN}]*[^{_HIDDEN}\s][^{_HIDDEN}]*$"
TEXT = r"^[^\x00]*$"
WORDS = r"^[^\x00]*[^\x00\s][^\x00]*$"


def _text(pattern: str, length: int, needed: str) -> tuple[AfterValidator, WithJsonSchema]:
    def check(text: str) -> str:
        if len(text) > length or re.search(pattern.removesuffix("$") + r"\Z", text) is None:
            raise ValueError(needed)
        return text.strip()

    least = {"minLength": 1} if pattern in (NAME, WORDS) else {}
    return AfterValidator(check), WithJsonSchema({"type": "string", **least, "maxLength": length, "pattern": pattern})


Name = Annotated[str, *_text(NAME, 200, "a name needs 1 to 200 printable characters")]
Label = Annotated[str, *_text(LABEL, 100, "needed at most 100 printable characters")]
LongLabel = Annotated[str, *_text(LABEL, 200, "needed at most 200 printable characters")]
Text = Annotated[str, *_text(TEXT, 4000, "needed at most 4000 characters, none of them NUL")]
Words = Annotated[str, *_text(WORDS, 4000, "needed 1 to 4000 characters, none of them NUL")]


def match_words(search: str | None, *columns: InstrumentedAttribute[str]) -> list[ColumnElement[bool]]:
    """Conditions for rows in which each word that is searched for stands in one of the columns, in any case."""
    return [or_(*(column.icontains(word, autoescape=True) for column in columns)) for word in (search or "").split()]

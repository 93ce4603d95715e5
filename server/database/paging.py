"""Lists in pages: `{"items", "next_cursor"}`. A cursor names the last thing seen: nothing is skipped or seen twice."""

from __future__ import annotations

import base64
import binascii
import json
import uuid
from datetime import datetime
from typing import Annotated, Any, Generic, TypeVar

from fastapi import Query
from pydantic import BaseModel, Field

from server.errors import NotFoundError

Item = TypeVar("Item")


class UnknownCursorError(NotFoundError):
    """No page of the list begins so."""

    def __init__(self, cursor: str) -> None:
        super().__init__(
            f"The cursor {cursor[:80]!r} is none of ours. Give the `next_cursor` of a page, or none for the first page."
        )


class Page(BaseModel, Generic[Item]):
    """Part of a list."""

    items: list[Item]
    next_cursor: str | None = Field(description="For `?cursor=` to get what follows; null at the end.")


Cursor = Annotated[
    str | None, Query(description="`next_cursor` of the page before.", max_length=1000, pattern="^[A-Za-z0-9_-]+$")
]
Limit = Annotated[int, Query(description="Most items of a page.", ge=1, le=1000)]


def write_cursor(*place: str | int) -> str:
    """A cursor for a place in a list."""
    return base64.urlsafe_b64encode(json.dumps(place).encode()).decode().rstrip("=")


def read_cursor(cursor: str, *kinds: type) -> list:
    """The place in a list that a cursor names; its parts have these kinds."""
    try:
        place = json.loads(base64.urlsafe_b64decode(cursor + "=" * (-len(cursor) % 4)))
    except (ValueError, binascii.Error, RecursionError):
        place = None
    if not isinstance(place, list) or [type(part) for part in place] != list(kinds) or not all(map(_is_sound, place)):
        raise UnknownCursorError(cursor)
    return place


def _is_sound(part: Any) -> bool:
    """Whether a database compares it: no number beyond all, no half a character."""
    if isinstance(part, str):
        return "\0" not in part and not any("\ud800" <= letter <= "\udfff" for letter in part)
    return abs(part) < 2**31  # false of NaN, too


def read_moment_cursor(cursor: str) -> tuple[datetime, uuid.UUID]:
    """The place in a list ordered by a moment and an id, written as `write_cursor(moment.isoformat(), str(id))`."""
    moment, id_ = read_cursor(cursor, str, str)
    try:
        place = datetime.fromisoformat(moment), uuid.UUID(id_)
    except ValueError:
        place = None
    if place is None or place[0].tzinfo is None:
        raise UnknownCursorError(cursor)
    return place


def read_id_cursor(cursor: str, kind: type) -> tuple[Any, uuid.UUID]:
    """The place in a list ordered by something of this kind and an id, written as `write_cursor(it, str(id))`."""
    first, id_ = read_cursor(cursor, kind, str)
    try:
        return first, uuid.UUID(id_)
    except ValueError:
        raise UnknownCursorError(cursor) from None

"""Lists in pages: `{"items", "next_cursor"}`. A cursor names the last thing seen: nothing is skipped or seen twice."""

from __future__ import annotations

import base64
import binascii
import json
import uuid
from collections.abc import Sequence
from datetime import datetime
from typing import Annotated, Any, Generic, TypeVar

from fastapi import Query
from pydantic import BaseModel, Field
from sqlalchemy import ColumnElement, Select, tuple_
from sqlalchemy.orm import InstrumentedAttribute, Session

from server.errors import NotFoundError

Item = TypeVar("Item")
Ordering = ColumnElement[Any] | InstrumentedAttribute[Any]


class UnknownCursorError(NotFoundError):
    """No page of the list begins so."""

    def __init__(self, cursor: str) -> None:
        super().__init__(
            f"The cursor {cursor[:80]!r} is not valid. Give the `next_cursor` of a page, or none for the first page."
        )


class Page(BaseModel, Generic[Item]):
    """Part of a list."""

    items: list[Item]
    next_cursor: str | None = Field(description="For `?cursor=` to get what follows; null at the end.")


Cursor = Annotated[
    str | None, Query(description="`next_cursor` of the page before.", max_length=1000, pattern="^[A-Za-z0-9_-]+$")
]
Limit = Annotated[int, Query(description="Most items of a page.", ge=1, le=1000)]


def write_cursor(*place: str | int | float) -> str:
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


def fetch_page(
    session: Session,
    query: Select[*tuple[Any, ...]],
    order: Sequence[Ordering],
    cursor: str | None,
    limit: int,
    *,
    is_falling: bool = True,
) -> tuple[list[Any], str | None]:
    """A page of what a query finds, and the cursor of the next page.

    Args:
        query: Of one entity, whose rows are given as they are, or of several things, given as tuples.
        order: Columns or expressions to go by; together no two rows have the same.
        cursor: Of a page before; None for the first.
        is_falling: The largest first, such as the newest; else the smallest.
    """
    place = tuple_(*order)
    if cursor is not None:
        after = _read_place(cursor, [column.type.python_type for column in order])
        beyond = place < after if is_falling else place > after
        query = query.having(beyond) if query._group_by_clauses else query.where(beyond)
    width = len(query.column_descriptions)
    ordered = query.add_columns(*order).order_by(*(column.desc() if is_falling else column for column in order))
    found = session.execute(ordered.limit(limit + 1)).all()
    rows = [row[0] if width == 1 else tuple(row)[:width] for row in found[:limit]]
    return rows, write_cursor(*map(_write_part, found[limit - 1][width:])) if len(found) > limit else None


def _write_part(value: Any) -> str | int | float:
    if isinstance(value, datetime):
        return value.isoformat()
    return str(value) if isinstance(value, uuid.UUID) else value


def _read_place(cursor: str, kinds: Sequence[type]) -> tuple[Any, ...]:
    written = [kind if kind in (int, float) else str for kind in kinds]
    return tuple(
        _read_part(cursor, part, kind) for part, kind in zip(read_cursor(cursor, *written), kinds, strict=True)
    )


def _read_part(cursor: str, part: Any, kind: type) -> Any:
    try:
        value = datetime.fromisoformat(part) if kind is datetime else uuid.UUID(part) if kind is uuid.UUID else part
    except ValueError:
        raise UnknownCursorError(cursor) from None
    if isinstance(value, datetime) and value.tzinfo is None:
        raise UnknownCursorError(cursor)
    return value

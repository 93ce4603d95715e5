"""What a kind of thing tells of itself, so that the bin can show it and bring it back."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any

from fastapi import Depends
from sqlalchemy import SQLColumnExpression
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.accounts.models import Account


@dataclass(frozen=True)
class BinKind:
    """A kind of thing that is put into the bin instead of being destroyed.

    Attributes:
        kind: As the audit trail calls it, such as `scan`.
        word: For people, such as `hand model`.
        id: Column of its id.
        name: What to call it.
        deleted_at: Column with the time when it was deleted; None is not.
        restore: Brings it back; given its id and who wants it.
        parent: Kind of the thing that it is part of, and the column with the id of that one.
        area: Where its files lie; None when it has none of its own.
    """

    kind: str
    word: str
    id: SQLColumnExpression[uuid.UUID]
    name: SQLColumnExpression[str]
    deleted_at: SQLColumnExpression[Any]
    restore: Callable[[Session, Account, uuid.UUID], object]
    parent: tuple[str, SQLColumnExpression[uuid.UUID]] | None = None
    area: str | None = None


async def get_bin_kinds(connection: HTTPConnection) -> tuple[BinKind, ...]:
    """Those the app was put together with."""
    return connection.app.state.bin_kinds


BinKindsDep = Annotated[tuple[BinKind, ...], Depends(get_bin_kinds)]

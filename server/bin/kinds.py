"""What a kind of thing tells of itself, so that the bin can show it, bring it back and delete it for good."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any

from fastapi import Depends
from sqlalchemy import SQLColumnExpression
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.access.audit import record_act
from server.access.models import Account
from server.database import Base


@dataclass(frozen=True)
class BinKind:
    """A kind of thing that is put into the bin instead of being destroyed.

    Attributes:
        kind: As the audit trail calls it, such as `scan`.
        word: For people, such as `hand model`.
        row: Its table, with `id` and `name`.
        deleted_at: Column with the time when it was deleted; None is not.
        restore: Brings it back; given its id and who wants it.
        parent: Kind of the thing that it is part of, and the column with the id of that one.
        area: Where its files lie; what has none of its own cannot be deleted for good.
    """

    kind: str
    word: str
    row: Any
    deleted_at: SQLColumnExpression[Any]
    restore: Callable[[Session, Account, uuid.UUID], object]
    parent: tuple[str, SQLColumnExpression[uuid.UUID]] | None = None
    area: str | None = None


def make_kind(
    kind: str,
    word: str,
    row: type[Base],
    area: str,
    parent: tuple[str, SQLColumnExpression[uuid.UUID]] | None = None,
) -> BinKind:
    """A thing with files of its own, which is back as soon as its row no longer says when it was deleted."""

    def restore(session: Session, account: Account, id_: uuid.UUID) -> None:
        found: Any = session.get_one(row, id_)
        found.deleted_at = None
        session.flush()
        record_act(session, account.id, f"{kind}.restore", kind, id_)

    return BinKind(kind, word, row, row.deleted_at, restore, parent, area)  # pyright: ignore[reportAttributeAccessIssue]


async def get_bin_kinds(connection: HTTPConnection) -> tuple[BinKind, ...]:
    """Those the app was put together with."""
    return connection.app.state.bin_kinds


BinKindsDep = Annotated[tuple[BinKind, ...], Depends(get_bin_kinds)]

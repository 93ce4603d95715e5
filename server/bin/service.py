"""What lies in the bin, of every kind together, and the way back."""

from __future__ import annotations

import uuid
from collections.abc import Sequence

from sqlalchemy import literal, select, union_all
from sqlalchemy.orm import Session

from server.access.models import Account, AuditRow
from server.access.service import find_names
from server.bin.kinds import BIN_KINDS, BinKind
from server.bin.schemas import BinItem
from server.database.paging import fetch_page
from server.errors import ConflictError, NotFoundError
from server.storage import Storage

ACTS = ("delete", "archive", "withdraw")


def list_bin(
    session: Session, storage: Storage, only: str | None, cursor: str | None, limit: int
) -> tuple[list[BinItem], str | None]:
    """What was deleted, the last first; with `only`, of one kind."""
    by_name = {kind.kind: kind for kind in BIN_KINDS}
    chosen = list(BIN_KINDS) if only is None else [find_kind(only)]
    together = union_all(
        *(
            select(
                literal(kind.kind).label("kind"),
                kind.row.id.label("id"),
                kind.row.name.label("name"),
                kind.deleted_at.label("deleted_at"),
            ).where(kind.deleted_at.is_not(None))
            for kind in chosen
        )
    ).subquery()
    order = (together.c.deleted_at, together.c.id)
    rows, next_cursor = fetch_page(session, select(together), order, cursor, limit)
    people = _find_deleters(session, [id_ for _, id_, _, _ in rows])
    items = [
        BinItem(
            kind=name,
            word=by_name[name].word,
            id=id_,
            name=called,
            deleted_at=deleted_at,
            deleted_by_name=people.get(id_),
            byte_count=_measure(storage, by_name[name], id_),
        )
        for name, id_, called, deleted_at in rows
    ]
    return items, next_cursor


def restore(session: Session, account: Account, name: str, id_: uuid.UUID) -> None:
    """Bring a thing back. What it is part of must be there: that is brought back first."""
    kind = find_kind(name)
    if not is_deleted(session, kind, id_):
        raise NotFoundError(f"The bin holds no {kind.word} {id_}. Somebody may have restored it.")
    if kind.parent is not None:
        parent = find_kind(kind.parent[0])
        parent_id = session.scalar(select(kind.parent[1]).where(kind.row.id == id_))
        if parent_id is not None and is_deleted(session, parent, parent_id):
            called = session.scalar(select(parent.row.name).where(parent.row.id == parent_id))
            raise ConflictError(
                f"The {parent.word} “{called}” that it belongs to is in the bin too. Restore that one first."
            )
    kind.restore(session, account, id_)


def find_kind(name: str) -> BinKind:
    for kind in BIN_KINDS:
        if kind.kind == name:
            return kind
    raise NotFoundError(f"The bin has no {name[:40]!r}; it has {', '.join(kind.kind for kind in BIN_KINDS)}.")


def is_deleted(session: Session, kind: BinKind, id_: uuid.UUID) -> bool:
    return session.scalar(select(kind.deleted_at).where(kind.row.id == id_)) is not None


def _find_deleters(session: Session, ids: Sequence[uuid.UUID]) -> dict[uuid.UUID, str]:
    """Who deleted things last, by their ids, as the audit trail says."""
    query = select(AuditRow.subject_id, AuditRow.account_id, AuditRow.act).where(AuditRow.subject_id.in_(ids))
    who: dict[uuid.UUID, uuid.UUID | None] = {}
    for row in session.execute(query.order_by(AuditRow.time)):
        if row.act.rpartition(".")[2] in ACTS:
            who[row.subject_id] = row.account_id
    names = find_names(session, who.values())
    return {id_: names[account] for id_, account in who.items() if account in names}


def _measure(storage: Storage, kind: BinKind, id_: uuid.UUID) -> int | None:
    return None if kind.area is None else measure_files(storage, kind.area, id_)


def measure_files(storage: Storage, area: str, id_: uuid.UUID) -> int:
    """Bytes of the files of a thing on this machine."""
    folder = storage.root / area / str(id_)
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())

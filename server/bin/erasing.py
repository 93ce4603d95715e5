"""Deleting for good: what hangs on a thing goes with it, and what others still need keeps it.

What hangs on what is read from the foreign keys of all tables; rooms above this one are known by their tables' names.
"""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import ColumnElement, Table, delete, func, or_, select, update
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.bin.kinds import BinKind
from server.bin.schemas import BinErasure, BinGoing
from server.bin.service import find_kind, is_deleted, measure_files
from server.database import Base
from server.errors import ConflictError, NotFoundError
from server.storage import Storage

WORDS = {
    "annotations": "label",
    "label_snapshots": "label snapshot",
    "tracks": "track",
    "assignments": "assignment",
    "replica_sets": "blind replica",
    "assignment_comments": "comment",
    "jobs": "job",
    "registrations": "registration",
    "decisions": "decision",
    "moving_registrations": "registration of frames",
    "frame_registrations": "registered frame",
    "stretch_decisions": "decision about frames",
}
"""What is told of what goes too; revisions, log lines and such go unnamed with what they are of."""

FOLDERS = {
    "sequences": "sequences",
    "tracks": "tracks",
    "scans": "scans",
    "registrations": "registrations",
    "moving_scans": "moving_scans",
    "moving_registrations": "moving_registrations",
    "frame_registrations": "frame_registrations",
    "hand_models": "models",
    "detectors": "detectors",
    "calibrations": "calibrations",
    "jobs": "jobs",
    "imports": "uploads",
}
DOCUMENTS = {"label_snapshots": "snapshots"}

GO_TOO = {("jobs", "sequence_id"), ("imports", "sequence_id"), ("jobs", "moving_scan_id")}
"""Columns that may be empty, of rows that mean nothing without what they name. Other such columns are emptied."""

NEEDS = {
    ("training_members", "registration_id"): "a training set was made from {word} of it",
    ("body_sets", "moving_scan_id"): "accepted frames of it are kept in a set",
    ("registrations", "model_id"): "registrations were made with it",
    ("decisions", "model_id"): "decisions were made about registrations by it",
    ("hand_models", "parent_id"): "a newer hand model was trained from it",
}
"""Columns whose rows keep what they name: a model must go on telling what it was made from."""


@dataclass
class Reach:
    """What hangs on a thing: conditions for rows that go, by table, and columns that are emptied."""

    going: dict[Table, list[ColumnElement[bool]]]
    emptied: list[tuple[Any, ColumnElement[bool]]] = field(default_factory=list)
    needed: list[tuple[str, Table, ColumnElement[bool]]] = field(default_factory=list)

    def ids(self, table: Table) -> Any:
        return select(table.c.id).where(or_(*self.going[table]))


def _find_reach(kind: BinKind, id_: uuid.UUID) -> Reach:
    root: Table = kind.row.__table__
    reach = Reach({root: [root.c.id == id_]})
    for table in Base.metadata.sorted_tables:  # each after those that it names
        for key in table.foreign_keys:
            parent, column = key.column.table, key.parent
            if parent not in reach.going:
                continue
            place = (table.name, column.name)
            condition = column.in_(reach.ids(parent))
            if place in NEEDS:
                reach.needed.append((NEEDS[place], table, condition))
            elif parent is table:
                continue  # such as a decision that takes another back: both are of the same registration
            elif column.nullable and place not in GO_TOO:
                reach.emptied.append((column, condition))
            else:
                reach.going.setdefault(table, []).append(condition)
    return reach


def describe(session: Session, storage: Storage, name: str, id_: uuid.UUID) -> BinErasure:
    """What would go with a thing in the bin, and why it cannot go if it cannot."""
    kind = _find_binned(session, name, id_)
    return _describe(session, storage, kind, id_, _find_reach(kind, id_))


def _describe(session: Session, storage: Storage, kind: BinKind, id_: uuid.UUID, reach: Reach) -> BinErasure:
    row = session.get_one(kind.row, id_)
    going = [
        BinGoing(word=WORDS[table.name], count=count)
        for table in reach.going
        if table is not kind.row.__table__ and table.name in WORDS
        if (count := _count(session, table, or_(*reach.going[table])))
    ]
    return BinErasure(
        word=kind.word,
        name=row.name,
        going=going,
        byte_count=sum(measure_files(storage, area, id_) for area, id_ in _list_folders(session, reach)),
        obstacle=_find_obstacle(session, kind, reach),
    )


def erase(
    session: Session, storage: Storage, account: Account, name: str, id_: uuid.UUID
) -> list[tuple[str, uuid.UUID]]:
    """Delete the rows; gives the folders and documents that are left without one, to be removed after the commit."""
    kind = _find_binned(session, name, id_)
    reach = _find_reach(kind, id_)
    told = _describe(session, storage, kind, id_, reach)
    if told.obstacle is not None:
        raise ConflictError(f"The {kind.word} “{told.name}” cannot be deleted for good: {told.obstacle}.")
    left = [*_list_folders(session, reach), *_list_documents(session, reach)]
    for column, condition in reach.emptied:
        session.execute(update(column.table).where(condition).values({column.name: None}))
    for table in reversed(Base.metadata.sorted_tables):
        if table in reach.going:
            session.execute(delete(table).where(or_(*reach.going[table])))
    session.expire_all()
    counts = {one.word: one.count for one in told.going}
    record_act(session, account.id, f"{kind.kind}.erase", kind.kind, id_, name=told.name, **counts)
    return left


def remove_files(storage: Storage, left: Sequence[tuple[str, uuid.UUID]]) -> None:
    """Remove what no row stands for any more."""
    for area, id_ in left:
        if area in DOCUMENTS.values():
            storage.remove_document(area, id_)
        else:
            storage.remove(area, id_)


def _find_binned(session: Session, name: str, id_: uuid.UUID) -> BinKind:
    kind = find_kind(name)
    if not is_deleted(session, kind, id_):
        raise NotFoundError(
            f"The bin holds no {kind.word} {id_}. Somebody may have restored it, or deleted it for good."
        )
    return kind


def _find_obstacle(session: Session, kind: BinKind, reach: Reach) -> str | None:
    if kind.area is None:
        return f"a {kind.word} holds no files, and its labels belong to recordings: it stays in the bin"
    for why, table, condition in reach.needed:
        if _count(session, table, condition):
            return why.format(word="a registration")
    tables = Base.metadata.tables
    jobs, listed = tables["jobs"], tables["job_scans"]
    touched = [condition for column, condition in reach.emptied if column.table is jobs]
    if jobs in reach.going:
        touched += reach.going[jobs]
    if listed in reach.going:
        touched.append(jobs.c.id.in_(select(listed.c.job_id).where(or_(*reach.going[listed]))))
    if touched and _count(session, jobs, or_(*touched) & jobs.c.state.in_(("queued", "running"))):
        return "a job that uses it waits or is at work: cancel it, or wait for it"
    return None


def _count(session: Session, table: Table, condition: ColumnElement[bool]) -> int:
    return session.scalar(select(func.count()).select_from(table).where(condition)) or 0


def _list_folders(session: Session, reach: Reach) -> list[tuple[str, uuid.UUID]]:
    return _list_files(session, reach, FOLDERS)


def _list_documents(session: Session, reach: Reach) -> list[tuple[str, uuid.UUID]]:
    return _list_files(session, reach, DOCUMENTS)


def _list_files(session: Session, reach: Reach, areas: dict[str, str]) -> list[tuple[str, uuid.UUID]]:
    return [
        (areas[table.name], id_)
        for table in reach.going
        if table.name in areas
        for id_ in session.scalars(reach.ids(table))
    ]

"""Looks up what changed in a recording, once for everybody who listens to it.

The labels' history is in the database, so this finds what any process of the studio has stored, on SQLite and on
PostgreSQL. A look costs two queries, of which the first reads only what was changed within the last seconds. What it
finds is written out once, and every listener gets the same text.
"""

from __future__ import annotations

import time
import uuid
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from threading import Lock
from typing import Any

from sqlalchemy import Select, bindparam, func, select
from sqlalchemy.orm import Session

from server.access.places import Place
from server.access.project_models import AssignmentRow, CommentRow, ProjectRow
from server.access.service import find_names
from server.annotations.models import AnnotationRow, KeyFrameRow
from server.database import Database, utc_now
from server.jobs.events import OVERLAP
from server.jobs.models import JobRow
from server.live.schemas import LabelChange
from server.sequences.models import SequenceRow

LOOK_SECONDS = 0.2
"""At most so often the database is asked about one recording, however many listen."""

KEPT_CHANGES = 5000
"""So many a watch remembers; who was away for longer looks up itself what it missed."""

IDLE_SECONDS = 60.0


@dataclass(frozen=True)
class Changed:
    """A label that changed, and where it lies; `text` is a LabelChange in JSON."""

    place: Place
    revision: int
    text: str


@dataclass(frozen=True)
class Look:
    """What a listener needs to know of a recording now.

    Attributes:
        number: Of the newest change; the next look goes on behind it.
        changes: Behind the number that was asked for; None when they are not remembered any more.
        looked_at: Changes stored before this are in it (but for `OVERLAP`).
        work: Differs when an assignment or a comment has changed.
        keys: Differs when a key frame was added or removed.
        jobs: Differs when a job, of whatever recording, has changed.
        state: Differs when anything of this does but `looked_at`.
    """

    number: int
    changes: Sequence[Changed] | None
    looked_at: datetime
    is_gone: bool
    work: tuple[Any, ...]
    keys: tuple[Any, ...]
    jobs: tuple[Any, ...]
    state: object


class RecordingWatch:
    """One recording; all who listen to it share this."""

    def __init__(self, sequence_id: uuid.UUID) -> None:
        self.sequence_id = sequence_id
        self.asked_at = time.monotonic()
        self._lock = Lock()
        self._looked: float | None = None
        self._looked_at = utc_now()
        self._revisions: dict[uuid.UUID, int] = {}
        self._changes: dict[uuid.UUID, tuple[int, Changed]] = {}
        self._number = self._forgotten = 0
        self._state: tuple[Any, ...] = ()
        self._newest_job = datetime.min.replace(tzinfo=UTC) + OVERLAP
        self.state: object = None

    def is_quiet(self, state: object) -> bool:
        """Whether who heard everything of this state need not look yet; costs no query."""
        self.asked_at = time.monotonic()
        return self._looked is not None and self.asked_at - self._looked < LOOK_SECONDS and state is self.state

    def look(self, database: Database, after: int) -> Look:
        """How it is, with the changes behind a number."""
        with self._lock:
            self.asked_at = now = time.monotonic()
            if self._looked is None or now - self._looked >= LOOK_SECONDS:
                number, state = self._number, self._state
                self._refresh(database)
                if (self._number, self._state) != (number, state):
                    self.state = object()
                self._looked = time.monotonic()
            changes = None
            if after >= self._forgotten:
                changes = [changed for number, changed in self._changes.values() if number > after]
            is_there, rest = self._state[0], self._state[1:]
            return Look(self._number, changes, self._looked_at, not is_there, rest[:6], rest[6:8], rest[8:], self.state)

    def _refresh(self, database: Database) -> None:
        now = utc_now()
        recent = AnnotationRow.updated_at > min(now, self._looked_at) - OVERLAP
        query = select(AnnotationRow.id, AnnotationRow.revision)
        with database.reading() as session:
            wanted = query.where(AnnotationRow.sequence_id == self.sequence_id, recent)
            found = {id_: revision for id_, revision in session.execute(wanted)}  # noqa: C416
            new = [id_ for id_, revision in found.items() if self._revisions.get(id_) != revision]
            for id_, changed in load_changes(session, AnnotationRow.id.in_(new)) if new else ():
                self._number += 1
                self._changes.pop(id_, None)
                self._changes[id_] = self._number, changed
            # After the labels: who is not to see one of them any more is known before it is handed on.
            asked = {"sequence": self.sequence_id, "jobs_after": self._newest_job - OVERLAP}
            self._state = tuple(session.execute(_STATE, asked).one())
        self._newest_job = self._state[-1] or self._newest_job
        self._revisions, self._looked_at = found, now
        for id_ in list(self._changes)[:-KEPT_CHANGES]:
            self._forgotten = self._changes.pop(id_)[0]


def load_changes(session: Session, *conditions: Any) -> list[tuple[uuid.UUID, Changed]]:
    """Labels for which the conditions hold, deleted ones too, the one that was changed first first."""
    rows = session.scalars(select(AnnotationRow).where(*conditions).order_by(AnnotationRow.updated_at)).all()
    names = find_names(session, [row.author_id for row in rows])
    fields = LabelChange.model_fields.keys() - {"author"}
    return [
        (
            row.id,
            Changed(
                Place(row.sequence_id, row.camera, row.frame, row.hand, row.replica),
                row.revision,
                LabelChange.model_validate(
                    {field: getattr(row, field) for field in fields} | {"author": names.get(row.author_id)}
                ).model_dump_json(),
            ),
        )
        for row in rows
    ]


def load_since(session: Session, sequence_id: uuid.UUID, since: datetime) -> list[Changed]:
    """Labels of a recording that were changed since then."""
    conditions = AnnotationRow.sequence_id == sequence_id, AnnotationRow.updated_at > since - OVERLAP
    return [changed for _, changed in load_changes(session, *conditions)]


def _select_state() -> Select[*tuple[Any, ...]]:
    """Whether the recording is there, how its assignments and comments are, its key frames, the jobs; in one query."""
    sequence_id = bindparam("sequence", type_=SequenceRow.id.type)
    work = select(AssignmentRow).where(AssignmentRow.sequence_id == sequence_id)
    comments = (
        select(CommentRow)
        .join(AssignmentRow, AssignmentRow.id == CommentRow.assignment_id)
        .where(AssignmentRow.sequence_id == sequence_id)
    )
    keys = select(KeyFrameRow).where(KeyFrameRow.sequence_id == sequence_id)
    projects = work.join(ProjectRow, ProjectRow.id == AssignmentRow.project_id)
    # As who listens to them asks (`AllJobsFeed`): what has changed since the newest change, or a little before it.
    jobs = select(JobRow).where(JobRow.updated_at > bindparam("jobs_after", type_=JobRow.updated_at.type))
    wanted: Collection[Any] = (
        select(func.count()).where(SequenceRow.id == sequence_id, SequenceRow.deleted_at.is_(None)),
        work.with_only_columns(func.count()),
        work.with_only_columns(func.sum(AssignmentRow.revision)),
        work.with_only_columns(func.max(AssignmentRow.updated_at)),
        projects.with_only_columns(func.count(ProjectRow.archived_at)),
        comments.with_only_columns(func.count()),
        comments.with_only_columns(func.count(CommentRow.resolved_at)),
        keys.with_only_columns(func.count()),
        keys.with_only_columns(func.max(KeyFrameRow.created_at)),
        jobs.with_only_columns(func.count()),
        jobs.with_only_columns(func.sum(JobRow.version)),
        jobs.with_only_columns(func.max(JobRow.updated_at)),
    )
    return select(*(query.scalar_subquery() for query in wanted))


_STATE = _select_state()


class Watches:
    """The watches of a process, one for each recording that somebody listens to."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._watches: dict[uuid.UUID, RecordingWatch] = {}

    def of(self, sequence_id: uuid.UUID) -> RecordingWatch:
        """The watch of a recording; those that nobody asks any more are forgotten."""
        idle_since = time.monotonic() - IDLE_SECONDS
        with self._lock:
            self._watches = {id_: one for id_, one in self._watches.items() if one.asked_at > idle_since}
            return self._watches.setdefault(sequence_id, RecordingWatch(sequence_id))

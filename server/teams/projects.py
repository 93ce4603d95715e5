"""Projects: recordings that belong together."""

from __future__ import annotations

import uuid
from collections.abc import Sequence

from sqlalchemy import func, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.access.project_models import AssignmentRow, ProjectRow, ProjectSequenceRow
from server.database import utc_now
from server.database.paging import fetch_page
from server.errors import ConflictError, NotFoundError
from server.sequences.models import SequenceRow
from server.teams.schemas import ProjectMake, ProjectOut, ProjectPatch, ProjectRecording, StateCounts


class StaleProjectError(ConflictError):
    """Somebody changed the project meanwhile; `row` is how it is now."""

    def __init__(self, row: ProjectRow) -> None:
        super().__init__(f"The project was changed meanwhile and is at revision {row.revision}. Load it again.")
        self.row = row


def list_projects(
    session: Session, archived: bool, cursor: str | None, limit: int
) -> tuple[Sequence[ProjectRow], str | None]:
    """Newest first, either those at work or those archived."""
    gone = ProjectRow.archived_at.is_not(None) if archived else ProjectRow.archived_at.is_(None)
    query = select(ProjectRow).where(gone)
    return fetch_page(session, query, (ProjectRow.created_at, ProjectRow.id), cursor, limit)


def describe_projects(session: Session, rows: Sequence[ProjectRow]) -> list[ProjectOut]:
    """Projects with what is in them."""
    ids = [row.id for row in rows]
    recordings = dict(
        session.execute(
            select(ProjectSequenceRow.project_id, func.count())
            .join(SequenceRow, SequenceRow.id == ProjectSequenceRow.sequence_id)
            .where(ProjectSequenceRow.project_id.in_(ids), SequenceRow.deleted_at.is_(None))
            .group_by(ProjectSequenceRow.project_id)
        ).all()
    )
    counts: dict[uuid.UUID, dict[str, int]] = {id_: {} for id_ in ids}
    states = session.execute(
        select(AssignmentRow.project_id, AssignmentRow.state, func.count())
        .where(AssignmentRow.project_id.in_(ids), AssignmentRow.deleted_at.is_(None))
        .group_by(AssignmentRow.project_id, AssignmentRow.state)
    )
    for id_, state, count in states:
        counts[id_][state] = count
    return [
        ProjectOut(
            id=row.id,
            name=row.name,
            description=row.description,
            revision=row.revision,
            created_at=row.created_at,
            archived_at=row.archived_at,
            recordings=recordings.get(row.id, 0),
            assignments=StateCounts(**counts[row.id]),
        )
        for row in rows
    ]


def get_project(session: Session, id_: uuid.UUID, *, working: bool = False, hold: bool = False) -> ProjectRow:
    """The project of this id; with `working`, it must not be archived."""
    query = select(ProjectRow).where(ProjectRow.id == id_)
    if hold:
        query = query.with_for_update().execution_options(populate_existing=True)
    row = session.scalars(query).one_or_none()
    if row is None:
        raise NotFoundError(f"The project {id_} does not exist.")
    if working and row.archived_at is not None:
        raise ConflictError(f"The project {row.name} is archived. Restore it first.")
    return row


def make_project(session: Session, account: Account, body: ProjectMake) -> ProjectRow:
    """A new project."""
    row = ProjectRow(name=body.name, description=body.description, created_by=account.id)
    try:
        with session.begin_nested():
            session.add(row)
            session.flush()
    except IntegrityError:
        raise _taken(body.name) from None
    record_act(session, account.id, "project.create", "project", row.id, name=row.name)
    return row


def update_project(
    session: Session, account: Account, id_: uuid.UUID, patch: ProjectPatch, revision: int
) -> ProjectRow:
    """Change a project, if it is still the revision given."""
    row = get_project(session, id_, hold=True)
    if row.revision != revision:
        raise StaleProjectError(row)
    changes = {name: value for name, value in patch.model_dump(exclude_unset=True).items() if value is not None}
    try:
        with session.begin_nested():
            for name, value in changes.items():
                setattr(row, name, value)
            row.revision += 1
            session.flush()
    except IntegrityError:
        raise _taken(changes["name"]) from None
    record_act(session, account.id, "project.update", "project", row.id, **changes)
    return row


def archive_project(session: Session, account: Account, id_: uuid.UUID, *, is_archived: bool) -> ProjectRow:
    """Put a project away, or bring it back. What was accepted stays locked meanwhile."""
    row = get_project(session, id_, hold=True)
    if (row.archived_at is not None) != is_archived:
        row.archived_at = utc_now() if is_archived else None
        row.revision += 1
        session.flush()
        act = "project.archive" if is_archived else "project.restore"
        record_act(session, account.id, act, "project", row.id, name=row.name)
    return row


def add_recording(session: Session, account: Account, project: ProjectRow, sequence: SequenceRow) -> None:
    """Take a recording into a project; nothing happens when it is there."""
    if _find_membership(session, project.id, sequence.id) is not None:
        return
    session.add(ProjectSequenceRow(project_id=project.id, sequence_id=sequence.id))
    session.flush()
    detail = {"sequence_id": str(sequence.id), "recording": sequence.name}
    record_act(session, account.id, "project.add_recording", "project", project.id, **detail)


def remove_recording(session: Session, account: Account, project: ProjectRow, sequence_id: uuid.UUID) -> None:
    """Take a recording out of a project; nothing happens when it is not there."""
    row = _find_membership(session, project.id, sequence_id)
    if row is None:
        return
    given = session.scalar(
        select(func.count())
        .select_from(AssignmentRow)
        .where(
            AssignmentRow.project_id == project.id,
            AssignmentRow.sequence_id == sequence_id,
            AssignmentRow.deleted_at.is_(None),
        )
    )
    if given:
        raise ConflictError(f"The recording has {given} assignments in {project.name}. Withdraw them first.")
    session.delete(row)
    session.flush()
    detail = {"sequence_id": str(sequence_id)}
    record_act(session, account.id, "project.remove_recording", "project", project.id, **detail)


def check_membership(session: Session, project: ProjectRow, sequence: SequenceRow) -> None:
    """Raise unless the recording is in the project."""
    if _find_membership(session, project.id, sequence.id) is None:
        raise ConflictError(f"{sequence.name} is not in the project {project.name}. Add the recording to it first.")


def list_recordings(
    session: Session, project: ProjectRow, cursor: str | None, limit: int
) -> tuple[list[ProjectRecording], str | None]:
    """Recordings of a project, in the order in which they were added."""
    order = (ProjectSequenceRow.added_at, ProjectSequenceRow.id)
    query = (
        select(ProjectSequenceRow, SequenceRow)
        .join(SequenceRow, SequenceRow.id == ProjectSequenceRow.sequence_id)
        .where(ProjectSequenceRow.project_id == project.id, SequenceRow.deleted_at.is_(None))
    )
    page, next_cursor = fetch_page(session, query, order, cursor, limit, is_falling=False)
    frames = _count_frames(session, project.id, [sequence.id for _, sequence in page])
    items = [
        ProjectRecording.model_validate(
            {
                "id": sequence.id,
                "name": sequence.name,
                "frame_count": sequence.frame_count,
                "cameras": [camera["id"] for camera in sequence.cameras],
                "hands": sequence.hands,
                "assigned_frames": sum(frames.get(sequence.id, {}).values()),
                "accepted_frames": frames.get(sequence.id, {}).get("accepted", 0),
                "added_at": member.added_at,
            }
        )
        for member, sequence in page
    ]
    return items, next_cursor


def _count_frames(
    session: Session, project_id: uuid.UUID, sequence_ids: Sequence[uuid.UUID]
) -> dict[uuid.UUID, dict[str, int]]:
    size = func.sum(AssignmentRow.frame_last - AssignmentRow.frame_first + 1)
    query = (
        select(AssignmentRow.sequence_id, AssignmentRow.state, size)
        .where(
            AssignmentRow.project_id == project_id,
            AssignmentRow.sequence_id.in_(sequence_ids),
            AssignmentRow.replica_set_id.is_(None),
            AssignmentRow.deleted_at.is_(None),
        )
        .group_by(AssignmentRow.sequence_id, AssignmentRow.state)
    )
    counts: dict[uuid.UUID, dict[str, int]] = {}
    for sequence_id, state, frames in session.execute(query):
        counts.setdefault(sequence_id, {})[state] = int(frames)
    return counts


def _find_membership(session: Session, project_id: uuid.UUID, sequence_id: uuid.UUID) -> ProjectSequenceRow | None:
    query = select(ProjectSequenceRow).where(
        ProjectSequenceRow.project_id == project_id, ProjectSequenceRow.sequence_id == sequence_id
    )
    return session.scalars(query).one_or_none()


def _taken(name: str) -> ConflictError:
    return ConflictError(f"There is a project named {name!r} already, maybe an archived one. Choose another name.")

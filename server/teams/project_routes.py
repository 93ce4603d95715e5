"""`/people` and `/projects`."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Query, Response
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.models import Account
from server.access.project_models import ProjectRow
from server.access.service import CurrentAccount, LeadAccount
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page, fetch_page
from server.database.revision import IfMatch, read_if_match, write_etag
from server.deprecation import deprecated
from server.errors import ConflictError, error_responses
from server.sequences.service import get_sequence
from server.teams import projects
from server.teams.schemas import Person, ProjectMake, ProjectOut, ProjectPatch, ProjectRecording

router = APIRouter(tags=["projects"], responses=error_responses(404))


@router.get("/people")
def list_people(
    session: SessionDep, account: CurrentAccount, cursor: Cursor = None, limit: Limit = 100
) -> Page[Person]:
    """Everybody who can be given work, by name."""
    query = select(Account).where(Account.disabled_at.is_(None))
    rows, next_cursor = fetch_page(session, query, (Account.name, Account.id), cursor, limit, is_falling=False)
    return Page(items=[Person(id=row.id, name=row.name, role=row.role) for row in rows], next_cursor=next_cursor)


@router.get("/projects")
def list_projects(
    session: SessionDep,
    account: CurrentAccount,
    archived: Annotated[bool, Query(description="Those put away instead of those at work.")] = False,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[ProjectOut]:
    """Projects, the newest first."""
    rows, next_cursor = projects.list_projects(session, archived, cursor, limit)
    return Page(items=projects.describe_projects(session, rows), next_cursor=next_cursor)


@router.post("/projects", status_code=201, responses=error_responses(409))
def make_project(body: ProjectMake, session: SessionDep, account: LeadAccount, response: Response) -> ProjectOut:
    """A new project. Leads make projects."""
    return _answer(session, projects.make_project(session, account, body), response)


@router.get("/projects/{project_id}")
def get_project(project_id: uuid.UUID, session: SessionDep, account: CurrentAccount, response: Response) -> ProjectOut:
    """One project."""
    return _answer(session, projects.get_project(session, project_id), response)


@router.patch("/projects/{project_id}", responses=error_responses(409, 428))
def update_project(
    project_id: uuid.UUID,
    patch: ProjectPatch,
    session: SessionDep,
    account: LeadAccount,
    response: Response,
    if_match: IfMatch = None,
) -> ProjectOut:
    """Change the name or the description. 409 carries the project as it is now in `theirs`."""
    try:
        row = projects.update_project(session, account, project_id, patch, read_if_match(if_match))
    except projects.StaleProjectError as stale:
        theirs = projects.describe_projects(session, [stale.row])[0].model_dump(mode="json")
        raise ConflictError(stale.detail, headers={"ETag": write_etag(stale.row.revision)}, theirs=theirs) from None
    return _answer(session, row, response)


@router.delete("/projects/{project_id}", status_code=204)
def archive_project(project_id: uuid.UUID, session: SessionDep, account: LeadAccount) -> None:
    """Archive a project; `restore` undoes it. What was accepted in it stays locked."""
    projects.archive_project(session, account, project_id, is_archived=True)


@router.post("/projects/{project_id}/restore", **deprecated("/bin/project/{project_id}/restore"))
def restore_project(project_id: uuid.UUID, session: SessionDep, account: LeadAccount, response: Response) -> ProjectOut:
    """Restore an archived project."""
    return _answer(session, projects.archive_project(session, account, project_id, is_archived=False), response)


@router.get("/projects/{project_id}/sequences")
def list_project_sequences(
    project_id: uuid.UUID, session: SessionDep, account: CurrentAccount, cursor: Cursor = None, limit: Limit = 100
) -> Page[ProjectRecording]:
    """Recordings of a project."""
    project = projects.get_project(session, project_id)
    items, next_cursor = projects.list_recordings(session, project, cursor, limit)
    return Page(items=items, next_cursor=next_cursor)


@router.put("/projects/{project_id}/sequences/{sequence_id}", status_code=204, responses=error_responses(409))
def add_project_sequence(
    project_id: uuid.UUID, sequence_id: uuid.UUID, session: SessionDep, account: LeadAccount
) -> None:
    """Add a recording to a project."""
    project = projects.get_project(session, project_id, working=True, hold=True)
    projects.add_recording(session, account, project, get_sequence(session, sequence_id))


@router.delete("/projects/{project_id}/sequences/{sequence_id}", status_code=204, responses=error_responses(409))
def remove_project_sequence(
    project_id: uuid.UUID, sequence_id: uuid.UUID, session: SessionDep, account: LeadAccount
) -> None:
    """Remove a recording from a project, if nothing of it is assigned there."""
    project = projects.get_project(session, project_id, working=True, hold=True)
    projects.remove_recording(session, account, project, sequence_id)


def _answer(session: Session, row: ProjectRow, response: Response) -> ProjectOut:
    response.headers["ETag"] = write_etag(row.revision)
    return projects.describe_projects(session, [row])[0]

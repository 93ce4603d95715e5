"""`/training-sets`."""

from __future__ import annotations

import tempfile
import uuid
from collections.abc import Iterator
from typing import IO

from fastapi import APIRouter, Response
from fastapi.responses import StreamingResponse

from server.access.service import ReviewerAccount
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.download import name_download
from server.errors import error_responses
from server.registrations import training_sets as service
from server.registrations.training_set_schemas import (
    TrainingMember,
    TrainingPreview,
    TrainingRule,
    TrainingSetMake,
    TrainingSetOut,
    TrainingVerification,
)
from server.storage import StorageDep

router = APIRouter(prefix="/training-sets", tags=["training sets"], responses=error_responses())

PIECE = 1024 * 1024


@router.get("")
def list_training_sets(session: SessionDep, cursor: Cursor = None, limit: Limit = 100) -> Page[TrainingSetOut]:
    """Training sets, the newest first."""
    rows, next_cursor = service.list_training_sets(session, cursor, limit)
    return Page(items=service.describe_training_sets(session, rows), next_cursor=next_cursor)


@router.post("", status_code=201, responses={200: {"model": TrainingSetOut}})
def create_training_set(
    body: TrainingSetMake, session: SessionDep, storage: StorageDep, account: ReviewerAccount, response: Response
) -> TrainingSetOut:
    """Keep what a rule chooses now. The same registrations are kept once: 200 and the set that holds them already."""
    row, is_new = service.create_training_set(session, storage, body.name, body.rule, account.id)
    response.status_code = 201 if is_new else 200
    return service.describe_training_sets(session, [row])[0]


@router.post("/preview")
def preview_training_set(rule: TrainingRule, session: SessionDep, account: ReviewerAccount) -> TrainingPreview:
    """What a rule would choose now. Nothing is stored."""
    return service.preview(session, rule)


@router.get("/{training_set_id}", responses=error_responses(404))
def get_training_set(training_set_id: uuid.UUID, session: SessionDep) -> TrainingSetOut:
    """One training set."""
    return service.describe_training_sets(session, [service.get_training_set(session, training_set_id)])[0]


@router.get("/{training_set_id}/registrations", responses=error_responses(404))
def list_training_members(
    training_set_id: uuid.UUID, session: SessionDep, cursor: Cursor = None, limit: Limit = 100
) -> Page[TrainingMember]:
    """Registrations of a training set, by the names of their scans."""
    service.get_training_set(session, training_set_id)
    items, next_cursor = service.list_members(session, training_set_id, cursor, limit)
    return Page(items=items, next_cursor=next_cursor)


@router.get("/{training_set_id}/verify", responses=error_responses(404))
def verify_training_set(training_set_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> TrainingVerification:
    """Compare every file with its SHA-256."""
    return service.verify_training_set(storage, service.get_training_set(session, training_set_id))


@router.get(
    "/{training_set_id}/registrations.zip",
    response_class=StreamingResponse,
    responses=error_responses(404, 409)
    | {200: {"content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}}}},
)
def download_training_set(training_set_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> StreamingResponse:
    """All registrations, as `handloom train-model` takes them, with the list of what they are."""
    row = service.get_training_set(session, training_set_id)
    file = tempfile.TemporaryFile(dir=storage.root)  # noqa: SIM115 (closed when it was sent)
    try:
        service.write_archive(storage, row, file)
    except BaseException:
        file.close()
        raise
    name = name_download(row.name, "training-set", row.digest[:12], suffix=".zip")
    headers = name | {"Content-Length": str(file.tell())}
    return StreamingResponse(_read_pieces(file), media_type="application/zip", headers=headers)


def _read_pieces(file: IO[bytes]) -> Iterator[bytes]:
    with file:
        file.seek(0)
        while piece := file.read(PIECE):
            yield piece

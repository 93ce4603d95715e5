"""`/body-sets`: accepted frames that are kept, and the models of people that are made from them."""

from __future__ import annotations

import tempfile
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response
from fastapi.responses import StreamingResponse

from server.access.service import ReviewerAccount
from server.compute import ComputeDep
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.download import name_download
from server.errors import error_responses
from server.moving_scans import body_sets as service
from server.moving_scans import person_models
from server.moving_scans.body_set_archive import write_archive
from server.moving_scans.decision_schemas import AcceptedFrames, BodySetMake, BodySetOut
from server.moving_scans.person_model_schemas import PersonModelOut
from server.moving_scans.service import get_moving_scan
from server.storage import StorageDep

router = APIRouter(tags=["moving scans"], responses=error_responses())

PIECE = 1024 * 1024


@router.get("/moving-scans/{moving_scan_id}/accepted", responses=error_responses(404))
def get_accepted_frames(moving_scan_id: uuid.UUID, session: SessionDep) -> AcceptedFrames:
    """Which registration of each frame counts now: the one accepted last; who accepted it, and what made it."""
    get_moving_scan(session, moving_scan_id, deleted_too=True)
    return service.describe_accepted(session, moving_scan_id)


@router.get("/body-sets")
def list_body_sets(
    session: SessionDep, moving_scan_id: uuid.UUID | None = None, cursor: Cursor = None, limit: Limit = 100
) -> Page[BodySetOut]:
    """Sets of accepted frames, the newest first."""
    rows, next_cursor = service.list_body_sets(session, moving_scan_id, cursor, limit)
    return Page(items=service.describe_body_sets(session, rows), next_cursor=next_cursor)


@router.post("/body-sets", status_code=201, responses={200: {"model": BodySetOut}, **error_responses(404)})
def create_body_set(body: BodySetMake, session: SessionDep, account: ReviewerAccount, response: Response) -> BodySetOut:
    """Keep what is accepted of a moving scan now. The same frames are kept once: 200 and the set that holds them."""
    scan = get_moving_scan(session, body.moving_scan_id)
    row, is_new = service.create_body_set(session, scan, body, account.id)
    response.status_code = 201 if is_new else 200
    return service.describe_body_sets(session, [row])[0]


@router.get("/body-sets/{body_set_id}", responses=error_responses(404))
def get_body_set(body_set_id: uuid.UUID, session: SessionDep) -> BodySetOut:
    """One set of accepted frames, with where each comes from."""
    return service.describe_body_sets(session, [service.get_body_set(session, body_set_id)])[0]


@router.get(
    "/body-sets/{body_set_id}/archive.zip",
    response_class=StreamingResponse,
    responses=error_responses(404, 409)
    | {200: {"content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}}}},
)
def download_body_set(
    body_set_id: uuid.UUID, session: SessionDep, storage: StorageDep, compute: ComputeDep
) -> StreamingResponse:
    """A motion as AMASS keeps it, the registered surfaces, the person's model, and the lineage of every frame."""
    row = service.get_body_set(session, body_set_id)
    with tempfile.NamedTemporaryFile(dir=storage.root, suffix=".zip", delete=False) as made:
        path = Path(made.name)
    try:
        compute.ask(write_archive, row.id, path)
    except BaseException:
        path.unlink(missing_ok=True)
        raise
    headers = name_download(row.name, "bodies", row.digest[:12], suffix=".zip")
    headers |= {"Content-Length": str(path.stat().st_size)}
    return StreamingResponse(_read_pieces(path), media_type="application/zip", headers=headers)


@router.post(
    "/body-sets/{body_set_id}/model",
    status_code=201,
    responses={200: {"model": PersonModelOut}, **error_responses(404, 409)},
)
def create_person_model(
    body_set_id: uuid.UUID, database: DatabaseDep, compute: ComputeDep, account: ReviewerAccount, response: Response
) -> PersonModelOut:
    """Make the model of the person from a set. There is one of each: 200 where it is there."""
    is_new = compute.ask(person_models.make_person_model, body_set_id, account.id)
    response.status_code = 201 if is_new else 200
    with database.reading() as session:
        row = person_models.get_person_model(session, person_models.name_person_model(body_set_id))
        return person_models.describe_person_models(session, [row])[0]


@router.get("/person-models", responses=error_responses(404))
def list_person_models(
    session: SessionDep,
    moving_scan_id: Annotated[
        uuid.UUID | None, Query(description="Those of its person: made from its sets, or of the same subject.")
    ] = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[PersonModelOut]:
    """Models of people, the newest first. `register_moving` takes one as `person_model_id`."""
    rows, next_cursor = person_models.list_person_models(session, moving_scan_id, cursor, limit)
    return Page(items=person_models.describe_person_models(session, rows), next_cursor=next_cursor)


@router.get(
    "/person-models/{person_model_id}/smplh.{kind}",
    response_class=Response,
    responses=error_responses(404)
    | {200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}},
)
def download_person_model(
    person_model_id: uuid.UUID, kind: Literal["npz", "pkl"], session: SessionDep, storage: StorageDep
) -> Response:
    """The model as a file that `smplx.SMPLH` loads; `betas` count from the person."""
    row = person_models.get_person_model(session, person_model_id)
    headers = name_download("SMPLH", row.name, suffix=f".{kind}")
    data = person_models.write_smplh(storage, row, kind)
    return Response(data, media_type="application/octet-stream", headers=headers)


def _read_pieces(path: Path) -> Iterator[bytes]:
    """The file piece by piece; it is gone as soon as it is open."""
    with path.open("rb") as file:
        path.unlink()
        while piece := file.read(PIECE):
            yield piece

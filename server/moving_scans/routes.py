"""`/moving-scans`."""

from __future__ import annotations

import uuid
from pathlib import Path, PurePosixPath
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.responses import FileResponse

from server.access.audit import record_act
from server.access.service import AccountIdDep, LeadAccount, require_lead
from server.compute import ComputeDep
from server.database import DatabaseDep, SessionDep
from server.database.frames import FramePath
from server.database.paging import Cursor, Limit, Page
from server.download import name_download
from server.errors import error_responses
from server.moving_scans import service
from server.moving_scans.adding import AREA, add_moving_scan
from server.moving_scans.describe import describe_moving_scans
from server.moving_scans.frame_files import THUMBNAIL
from server.moving_scans.schemas import MovingScanAdded, MovingScanOptions, MovingScanOut, MovingScanPatch
from server.scans.geometry import MEDIA_TYPE
from server.scans.routes import GEOMETRY, IMMUTABLE, UPLOADS, read_limits, unpack_upload
from server.storage import StorageDep
from server.storage.sent_json import read_options, reading_json
from server.storage.upload import Upload, work_on_upload
from server.storage.upload_body import describe_upload_body

router = APIRouter(prefix="/moving-scans", tags=["moving scans"], responses=error_responses())

_BODY = describe_upload_body(
    "PLY, OBJ or STL files, one a frame, in the order of their names; or one .zip of them.",
    options={"type": "string", "description": "JSON: `name`, `subject`, `fps` (60), `metres_per_unit`."},
)


@router.get("")
def list_moving_scans(
    session: SessionDep,
    search: Annotated[str | None, Query(max_length=200, description="Words of the name or the subject.")] = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[MovingScanOut]:
    """Moving scans, the newest first."""
    rows, next_cursor = service.list_moving_scans(session, search, cursor, limit)
    return Page(items=describe_moving_scans(session, rows), next_cursor=next_cursor)


@router.post(
    "",
    status_code=201,
    responses={200: {"model": MovingScanAdded}, **error_responses(413, 507)},
    openapi_extra=_BODY,
    dependencies=[Depends(require_lead)],
)
async def create_moving_scan(
    request: Request,
    response: Response,
    database: DatabaseDep,
    storage: StorageDep,
    compute: ComputeDep,
    account_id: AccountIdDep,
) -> MovingScanAdded:
    """Upload the scans of one moving person, or one scan of a person. A file that cannot be used keeps its place and
    is named; the others go on."""
    limits = read_limits(request)

    def work(folder: Path, upload: Upload) -> MovingScanAdded:
        with reading_json("The form", "`name`, `subject`, `fps` and `metres_per_unit` as `options`, all optional"):
            options = MovingScanOptions.model_validate(read_options(upload.fields.get("options", "")))
        source = unpack_upload(folder, upload, limits)
        stem = PurePosixPath(upload.names[0]).stem if source != folder else ""
        fallback = "".join(letter for letter in stem if letter.isprintable()).strip()[:200] or "Moving scan"
        row, is_new = add_moving_scan(database, storage, compute, source, fallback, options, account_id)
        with database.reading() as session:
            return MovingScanAdded(moving_scan=describe_moving_scans(session, [row])[0], is_known=not is_new)

    added = await work_on_upload(request, storage, UPLOADS, limits, work)
    response.status_code = 200 if added.is_known else 201
    return added


@router.get("/{moving_scan_id}", responses=error_responses(404))
def get_moving_scan(moving_scan_id: uuid.UUID, session: SessionDep) -> MovingScanOut:
    """One moving scan."""
    return describe_moving_scans(session, [service.get_moving_scan(session, moving_scan_id)])[0]


@router.patch("/{moving_scan_id}", responses=error_responses(404))
def update_moving_scan(
    moving_scan_id: uuid.UUID, patch: MovingScanPatch, session: SessionDep, lead: LeadAccount
) -> MovingScanOut:
    """Change name, subject or frames per second."""
    row = service.get_moving_scan(session, moving_scan_id)
    service.update_moving_scan(session, row, patch)
    record_act(session, lead.id, "moving_scan.change", "moving_scan", row.id)
    return describe_moving_scans(session, [row])[0]


@router.delete("/{moving_scan_id}", status_code=204, responses=error_responses(404))
def delete_moving_scan(moving_scan_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Put a moving scan into the bin; it can be restored from there."""
    service.delete_moving_scan(session, service.get_moving_scan(session, moving_scan_id))
    record_act(session, lead.id, "moving_scan.delete", "moving_scan", moving_scan_id)


@router.get(
    "/{moving_scan_id}/frames/{frame}/geometry", response_class=Response, responses=GEOMETRY | error_responses(404)
)
def get_frame_geometry(
    moving_scan_id: uuid.UUID, frame: FramePath, session: SessionDep, storage: StorageDep
) -> Response:
    """A frame's points for the browser, as those of a scan. They never change."""
    row = service.get_moving_scan(session, moving_scan_id, deleted_too=True)
    data = service.find_frame_view(storage, row, frame).read_bytes()
    return Response(data, media_type=MEDIA_TYPE, headers={"Cache-Control": IMMUTABLE})


@router.get(
    "/{moving_scan_id}/frames/{frame}/file",
    response_class=FileResponse,
    responses=error_responses(404)
    | {200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}},
)
def download_frame(
    moving_scan_id: uuid.UUID, frame: FramePath, session: SessionDep, storage: StorageDep
) -> FileResponse:
    """The file of a frame as it was uploaded."""
    row = service.get_moving_scan(session, moving_scan_id)
    path = service.find_scan_file(storage, row, frame)
    headers = name_download(row.name, f"{frame:06d}", suffix=path.suffix)
    return FileResponse(path, media_type="application/octet-stream", headers=headers)


@router.get(
    "/{moving_scan_id}/thumbnail.png",
    response_class=FileResponse,
    responses={200: {"content": {"image/png": {"schema": {"type": "string", "format": "binary"}}}}}
    | error_responses(404),
)
def get_moving_scan_thumbnail(moving_scan_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> FileResponse:
    """A small picture of the first frame that can be used. It never changes."""
    row = service.get_moving_scan(session, moving_scan_id, deleted_too=True)
    path = storage.folder(AREA, row.id) / THUMBNAIL
    return FileResponse(path, media_type="image/png", headers={"Cache-Control": IMMUTABLE})

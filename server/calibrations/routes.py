"""`/calibrations`."""

from __future__ import annotations

import uuid
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Depends, Request
from fastapi import Path as InPath
from fastapi.responses import FileResponse
from pydantic import BaseModel

from server.access.service import AccountIdDep, LeadAccount, require_lead
from server.calibrations import films, service, storing
from server.calibrations.schemas import CalibrationCheck, CalibrationOptions, CalibrationOut, ResultFile
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.database.texts import Name
from server.download import name_download
from server.errors import error_responses
from server.storage import StorageDep
from server.storage.sent_json import read_options, reading_json
from server.storage.upload import Upload, UploadLimits, work_on_upload
from server.storage.upload_body import describe_upload_body

router = APIRouter(prefix="/calibrations", tags=["calibrations"], responses=error_responses())

by_lead = [Depends(require_lead)]
MEDIA_TYPES = {".toml": "application/toml", ".yaml": "application/yaml", ".zip": "application/zip"}
MEDIA_TYPES |= {".json": "application/json", ".txt": "text/plain"}

_BODY = describe_upload_body(
    "A video, a folder of images or a .zip of them for each camera, named as the camera is; or one .zip of all. A "
    "folder `lenses` beside them holds a calibration whose lenses are known.",
    name={"type": "string", "description": "Of the calibration."},
    options={"type": "string", "description": "JSON: how to calibrate; `/calibrations/form` has the defaults."},
)


class _Fields(BaseModel):
    """What the form says beside its files."""

    name: Name = "Cameras"
    options: CalibrationOptions


@router.get("")
def list_calibrations(session: SessionDep, cursor: Cursor = None, limit: Limit = 100) -> Page[CalibrationOut]:
    """Camera calibrations, the newest first."""
    rows, next_cursor = service.list_calibrations(session, cursor, limit)
    return Page(items=[CalibrationOut.model_validate(row) for row in rows], next_cursor=next_cursor)


@router.post("", status_code=201, responses=error_responses(413, 507), openapi_extra=_BODY, dependencies=by_lead)
async def create_calibration(
    request: Request, database: DatabaseDep, storage: StorageDep, account_id: AccountIdDep
) -> CalibrationOut:
    """Upload what cameras filmed of a board, and have it checked. A job of the kind `calibrate` calibrates them."""
    settings = request.app.state.settings
    limits = UploadLimits(settings.max_upload_files, settings.max_upload_bytes)

    def work(folder: Path, upload: Upload) -> CalibrationOut:
        with reading_json("The form", "`name`, and `options` as `/calibrations/form` has them"):
            told = {"name": name} if (name := upload.fields.get("name", "").strip()) else {}
            fields = _Fields.model_validate({**told, "options": read_options(upload.fields.get("options", ""))})
        films_id = films.keep_films(storage, folder, upload, limits)
        row = service.add_calibration(database, storage, films_id, fields.name, fields.options, upload, account_id)
        return CalibrationOut.model_validate(row)

    return await work_on_upload(request, storage, films.UPLOADS, limits, work)


@router.get("/{calibration_id}", responses=error_responses(404))
def get_calibration(calibration_id: uuid.UUID, session: SessionDep) -> CalibrationOut:
    """One camera calibration: what was filmed, and what was found."""
    return CalibrationOut.model_validate(service.get_calibration(session, calibration_id))


@router.post("/{calibration_id}/check", dependencies=by_lead, responses=error_responses(404, 409))
def check_calibration(
    calibration_id: uuid.UUID,
    body: CalibrationCheck,
    database: DatabaseDep,
    storage: StorageDep,
    account_id: AccountIdDep,
) -> CalibrationOut:
    """Check the films with other options. A calibration with a result stays; the answer is a new one."""
    return CalibrationOut.model_validate(service.check_again(database, storage, calibration_id, body, account_id))


@router.delete("/{calibration_id}", status_code=204, responses=error_responses(404))
def delete_calibration(calibration_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Put a camera calibration into the bin; it can be restored from there."""
    service.delete_calibration(session, service.get_calibration(session, calibration_id), lead.id)


@router.get(
    "/{calibration_id}/files/{name}",
    response_class=FileResponse,
    responses={200: {"content": {media_type: {} for media_type in sorted(set(MEDIA_TYPES.values()))}}}
    | error_responses(404),
)
def download_calibration(
    calibration_id: uuid.UUID, name: ResultFile, session: SessionDep, storage: StorageDep
) -> FileResponse:
    """A file of the result: the cameras as Anipose, OpenCV or COLMAP have them, the report, the board."""
    row = service.get_calibration(session, calibration_id)
    path = service.find_file(storage, row, name)
    headers = name_download(row.name, path.stem, suffix=path.suffix)
    return FileResponse(path, media_type=MEDIA_TYPES[path.suffix], headers=headers)


@router.get(
    "/{calibration_id}/coverage/{number}.png",
    response_class=FileResponse,
    responses={200: {"content": {"image/png": {"schema": {"type": "string", "format": "binary"}}}}}
    | error_responses(404),
)
def get_coverage(
    calibration_id: uuid.UUID,
    number: Annotated[int, InPath(ge=0, lt=64, description="Of the camera, from 0.")],
    session: SessionDep,
    storage: StorageDep,
) -> FileResponse:
    """Where in a camera's picture the board was seen, and how well it fits there."""
    row = service.get_calibration(session, calibration_id)
    path = service.find_file(storage, row, storing.COVERAGE.format(number))
    headers = {"Cache-Control": "private, max-age=31536000, immutable"}
    return FileResponse(path, media_type="image/png", headers=headers)

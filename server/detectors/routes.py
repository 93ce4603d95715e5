"""`/detectors`."""

from __future__ import annotations

import uuid
from pathlib import Path

from fastapi import APIRouter, Depends, Request
from fastapi.responses import FileResponse

from server.access.service import AccountIdDep, LeadAccount, require_lead
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.detectors import service
from server.detectors.schemas import DetectorOptions, DetectorOut
from server.download import name_download
from server.errors import error_responses
from server.storage import StorageDep
from server.storage.upload import Upload, UploadLimits, work_on_upload
from server.storage.upload_body import describe_upload_body, read_one_file

router = APIRouter(tags=["detectors"], responses=error_responses())

LIMITS = UploadLimits(files=1, total_bytes=32 * 2**20)
_BODY = describe_upload_body(
    "One .npz as `handloom train-detector` writes it.",
    is_one=True,
    name={"type": "string", "description": "Of the detector; the file's when left out."},
)


@router.get("/detectors")
def list_detectors(session: SessionDep, cursor: Cursor = None, limit: Limit = 100) -> Page[DetectorOut]:
    """Fingertip detectors that were uploaded, the newest first."""
    rows, next_cursor = service.list_detectors(session, cursor, limit)
    return Page(items=[DetectorOut.model_validate(row) for row in rows], next_cursor=next_cursor)


@router.get("/detectors/{detector_id}", responses=error_responses(404))
def get_detector(detector_id: uuid.UUID, session: SessionDep) -> DetectorOut:
    """One fingertip detector."""
    return DetectorOut.model_validate(service.get_detector(session, detector_id))


@router.get(
    "/detectors/{detector_id}/detector.npz",
    response_class=FileResponse,
    responses={200: {"content": {"application/octet-stream": {}}}} | error_responses(404, 409),
)
def download_detector(detector_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> FileResponse:
    """The file of a fingertip detector, as it was uploaded."""
    row = service.get_detector(session, detector_id)
    path = service.find_file(storage, row)
    headers = name_download(row.name, row.digest[:12], suffix=".npz")
    return FileResponse(path, media_type="application/octet-stream", headers=headers)


@router.post(
    "/detectors",
    status_code=201,
    responses=error_responses(413, 507),
    openapi_extra=_BODY,
    dependencies=[Depends(require_lead)],
)
async def upload_detector(
    request: Request, database: DatabaseDep, storage: StorageDep, account_id: AccountIdDep
) -> DetectorOut:
    """Upload a fingertip detector that `handloom train-detector` wrote; tracking jobs can use it."""

    def work(folder: Path, upload: Upload) -> DetectorOut:
        path, options = read_one_file(folder, upload, "detector", DetectorOptions, "a file, and a name")
        detector = service.read_upload(path)
        with database.writing() as session:
            row = service.add_detector(session, storage, path, detector, options.name or path.stem, account_id)
            return DetectorOut.model_validate(row)

    return await work_on_upload(request, storage, "detector_uploads", LIMITS, work)


@router.delete("/detectors/{detector_id}", status_code=204, responses=error_responses(404))
def delete_detector(detector_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Put a fingertip detector into the bin; it can be restored from there."""
    service.delete_detector(session, service.get_detector(session, detector_id), lead.id)

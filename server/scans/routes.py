"""`/scans`."""

from __future__ import annotations

import uuid
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Query, Request, Response
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.service import AccountIdDep, CurrentAccount, LeadAccount, find_names, require_lead
from server.compute import ComputeDep
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.database.revision import IfMatch, read_if_match, write_etag
from server.deprecation import deprecated
from server.download import name_download
from server.errors import ConflictError, error_responses
from server.scans import computing, service
from server.scans.adding import add_scans, parse_options
from server.scans.geometry import MEDIA_TYPE
from server.scans.models import ScanCropRow, ScanRow
from server.scans.schemas import (
    CollectionOut,
    ScanCrop,
    ScanCropOut,
    ScanOut,
    ScanPatch,
    ScansAdded,
    ScansMeasured,
    ScanUnit,
    Side,
    State,
)
from server.scans.summaries import ResizedDep, SummariesDep, SummaryFinder, describe_scans
from server.scans.units import find_revision_unit
from server.storage import StorageDep
from server.storage.upload import Upload, UploadLimits, work_on_upload
from server.storage.upload_body import describe_upload_body
from tracker.capture import ArchiveLimits, extract_archive

router = APIRouter(prefix="/scans", tags=["scans"], responses=error_responses())

UPLOADS = "scan_uploads"
IMMUTABLE = "private, max-age=31536000, immutable"
GEOMETRY: dict[int | str, dict[str, Any]] = {
    200: {
        "content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}},
        "description": "Arrays, as `docs/scans.md` describes them.",
    }
}
_BODY = describe_upload_body(
    "PLY, OBJ or STL files, perhaps with a `scans.json`; or one .zip of them.",
    options={
        "type": "string",
        "description": "JSON: `collection`, and for scans that no `scans.json` names `subject`, "
        "`pose`, `side`, `metres_per_unit`; `units`, metres per unit by the path of a file.",
    },
)


@router.get("")
def list_scans(
    session: SessionDep,
    summaries: SummariesDep,
    collection: Annotated[str | None, Query(max_length=200)] = None,
    subject: Annotated[str | None, Query(max_length=100)] = None,
    pose: Annotated[str | None, Query(max_length=100)] = None,
    side: Side | None = None,
    state: State | None = None,
    search: Annotated[str | None, Query(max_length=200, description="Words of the name.")] = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[ScanOut]:
    """Scans, the newest first."""
    wanted = service.ScanFilter(collection, subject, pose, side, state, search)
    rows, next_cursor = service.list_scans(session, wanted, cursor, limit)
    return Page(items=describe_scans(session, rows, summaries), next_cursor=next_cursor)


@router.post(
    "",
    status_code=201,
    responses=error_responses(413, 507),
    openapi_extra=_BODY,
    dependencies=[Depends(require_lead)],
)
async def create_scans(
    request: Request, database: DatabaseDep, storage: StorageDep, summaries: SummariesDep, account_id: AccountIdDep
) -> ScansAdded:
    """Upload scans. Each file is judged by itself; one sent again is not kept twice."""
    limits = read_limits(request)

    def work(folder: Path, upload: Upload) -> ScansAdded:
        options = parse_options(upload.fields.get("options", ""))
        source = unpack_upload(folder, upload, limits)
        done = add_scans(database, storage, source, options, account_id, moves=True)
        with database.reading() as session:
            return ScansAdded(
                added=describe_scans(session, done.added, summaries),
                known=describe_scans(session, done.known, summaries),
                refused=done.refused,
                notes=done.notes,
            )

    return await work_on_upload(request, storage, UPLOADS, limits, work)


@router.post("/measure", responses=error_responses(413, 507), openapi_extra=_BODY, dependencies=[Depends(require_lead)])
async def measure_scans(request: Request, storage: StorageDep, compute: ComputeDep) -> ScansMeasured:
    """How large scans would be, in which units: the files of an upload are looked at, and nothing is stored."""
    limits = read_limits(request)
    return await work_on_upload(
        request,
        storage,
        UPLOADS,
        limits,
        lambda folder, upload: compute.ask(computing.measure_folder, unpack_upload(folder, upload, limits)),
    )


def read_limits(request: Request) -> UploadLimits:
    """What the settings let an upload bring."""
    settings = request.app.state.settings
    return UploadLimits(settings.max_upload_files, settings.max_upload_bytes)


def unpack_upload(folder: Path, upload: Upload, limits: UploadLimits) -> Path:
    """The folder with the files of an upload, those of a zip when it is one."""
    if len(upload.names) != 1 or not upload.names[0].lower().endswith(".zip"):
        return folder
    allowed = ArchiveLimits(files=limits.files, total_bytes=limits.total_bytes)
    extract_archive(folder / upload.names[0], folder / ".unpacked", allowed)
    return folder / ".unpacked"


@router.get("/collections")
def list_scan_collections(session: SessionDep) -> Page[CollectionOut]:
    """Collections of scans, by name."""
    return Page(items=service.list_collections(session), next_cursor=None)


@router.get("/{scan_id}", responses=error_responses(404))
def get_scan(scan_id: uuid.UUID, session: SessionDep, summaries: SummariesDep, response: Response) -> ScanOut:
    """One scan."""
    row = service.get_scan(session, scan_id)
    response.headers["ETag"] = write_etag(row.revision)
    return describe_scans(session, [row], summaries)[0]


@router.patch("/{scan_id}", responses=error_responses(404))
def update_scan(
    scan_id: uuid.UUID, patch: ScanPatch, session: SessionDep, summaries: SummariesDep, lead: LeadAccount
) -> ScanOut:
    """Change name, collection, subject or pose."""
    row = service.get_scan(session, scan_id)
    service.update_scan(session, row, patch)
    record_act(session, lead.id, "scan.change", "scan", row.id)
    return describe_scans(session, [row], summaries)[0]


@router.delete("/{scan_id}", status_code=204, responses=error_responses(404))
def delete_scan(scan_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Hide a scan. Nothing of it is lost: `restore` brings it back."""
    service.delete_scan(session, service.get_scan(session, scan_id))
    record_act(session, lead.id, "scan.delete", "scan", scan_id)


@router.post("/{scan_id}/restore", responses=error_responses(404), **deprecated("/bin/scan/{scan_id}/restore"))
def restore_scan(scan_id: uuid.UUID, session: SessionDep, summaries: SummariesDep, lead: LeadAccount) -> ScanOut:
    """Undo a deletion."""
    row = service.get_scan(session, scan_id, deleted_too=True)
    service.restore_scan(session, row)
    record_act(session, lead.id, "scan.restore", "scan", row.id)
    return describe_scans(session, [row], summaries)[0]


@router.get(
    "/{scan_id}/file",
    response_class=Response,
    responses=error_responses(404)
    | {200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}},
)
def download_scan(scan_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> Response:
    """The file as it was uploaded."""
    row = service.get_scan(session, scan_id)
    data = (storage.folder(service.AREA, row.id) / row.file).read_bytes()
    headers = name_download(row.name, "scan", row.digest[:12], suffix=Path(row.file).suffix)
    headers |= {"ETag": f'"{row.digest}"'}
    return Response(data, media_type="application/octet-stream", headers=headers)


@router.get("/{scan_id}/geometry/{key}", response_class=Response, responses=GEOMETRY | error_responses(404))
def get_scan_geometry(
    scan_id: uuid.UUID,
    key: str,
    session: SessionDep,
    compute: ComputeDep,
    size: Annotated[int, Query(ge=1, le=200_000, description="Most points.")] = 20_000,
) -> Response:
    """Points for the browser: positions, normals, colours, flags (1 cropped, 2 object or loose). It never changes."""
    row = service.get_scan(session, scan_id, deleted_too=True)
    revision = service.find_geometry_revision(row, key)
    crop = service.get_crop(session, scan_id, revision)
    return Response(
        compute.ask(computing.pack_scan, row, crop, size), media_type=MEDIA_TYPE, headers={"Cache-Control": IMMUTABLE}
    )


@router.get(
    "/{scan_id}/thumbnail/{key}.png",
    response_class=Response,
    responses={200: {"content": {"image/png": {"schema": {"type": "string", "format": "binary"}}}}}
    | error_responses(404),
)
def get_scan_thumbnail(scan_id: uuid.UUID, key: str, session: SessionDep, compute: ComputeDep) -> Response:
    """A small picture for lists, of what is not left out; `key` is the `geometry_key`. It never changes."""
    row = service.get_scan(session, scan_id, deleted_too=True)
    crop = service.get_crop(session, scan_id, service.find_geometry_revision(row, key))
    return Response(
        compute.ask(computing.draw_scan, row, crop), media_type="image/png", headers={"Cache-Control": IMMUTABLE}
    )


@router.get("/{scan_id}/crop", responses=error_responses(404))
def get_scan_crop(scan_id: uuid.UUID, session: SessionDep, response: Response) -> ScanCropOut:
    """What is left out of a scan now."""
    row = service.get_scan(session, scan_id)
    response.headers["ETag"] = write_etag(row.revision)
    return _describe_crops(session, row, [service.get_crop(session, scan_id, row.revision)])[0]


@router.put("/{scan_id}/crop", responses=error_responses(404, 409, 428))
def put_scan_crop(
    scan_id: uuid.UUID,
    crop: ScanCrop,
    session: SessionDep,
    compute: ComputeDep,
    summaries: SummariesDep,
    account: CurrentAccount,
    response: Response,
    if_match: IfMatch = None,
) -> ScanOut:
    """Replace what is left out of a scan; the file stays as it is. 409 carries the scan as it is now in `theirs`."""
    row = service.get_scan(session, scan_id)
    revision = read_if_match(if_match)
    try:
        kept = compute.ask(computing.crop_scan, row, crop)
        row = service.put_crop(session, row, crop, kept, revision, account.id)
    except service.StaleScanError as stale:
        raise _write_conflict(session, scan_id, summaries, stale) from None
    record_act(session, account.id, "scan.crop", "scan", row.id, revision=row.revision)
    response.headers["ETag"] = write_etag(row.revision)
    return describe_scans(session, [row], summaries)[0]


@router.put("/{scan_id}/unit", responses=error_responses(404, 409, 428))
def put_scan_unit(
    scan_id: uuid.UUID,
    unit: ScanUnit,
    session: SessionDep,
    storage: StorageDep,
    compute: ComputeDep,
    summaries: SummariesDep,
    resized: ResizedDep,
    lead: LeadAccount,
    response: Response,
    if_match: IfMatch = None,
) -> ScanOut:
    """Say or correct the unit of a scan's file. Crops stay; registrations of another size no longer count. 409 carries
    the scan as it is now in `theirs`."""
    row = service.get_scan(session, scan_id)
    revision = read_if_match(if_match)
    service.settle_old_unit(session, storage, row)
    before = row.metres_per_unit
    try:
        crop = service.get_crop(session, row.id, row.revision)
        scaled = compute.ask(computing.give_unit, row, crop, unit.metres_per_unit)
        row = service.put_unit(session, row, scaled, revision, lead.id)
    except service.StaleScanError as stale:
        raise _write_conflict(session, scan_id, summaries, stale) from None
    for settle in resized:
        settle(session, row)
    detail = {"revision": row.revision, "from": before, "to": row.metres_per_unit}
    record_act(session, lead.id, "scan.unit", "scan", row.id, **detail)
    response.headers["ETag"] = write_etag(row.revision)
    return describe_scans(session, [row], summaries)[0]


def _write_conflict(
    session: Session, scan_id: uuid.UUID, summaries: tuple[SummaryFinder, ...], stale: service.StaleScanError
) -> ConflictError:
    row = service.get_scan(session, scan_id)
    theirs = describe_scans(session, [row], summaries)[0].model_dump(mode="json")
    return ConflictError(stale.detail, headers={"ETag": write_etag(row.revision)}, theirs=theirs)


@router.get("/{scan_id}/crop/history", responses=error_responses(404))
def list_scan_crops(scan_id: uuid.UUID, session: SessionDep) -> Page[ScanCropOut]:
    """Every crop of a scan, the newest first. To go back to one, put its strokes again."""
    row = service.get_scan(session, scan_id)
    crops = [*service.list_crops(session, scan_id), None]
    return Page(items=_describe_crops(session, row, crops), next_cursor=None)


def _describe_crops(session: Session, scan: ScanRow, rows: list[ScanCropRow | None]) -> list[ScanCropOut]:
    people = find_names(session, (row.author_id for row in rows if row is not None))
    names = ("revision", "strokes", "drops_objects", "removed_count", "created_at")
    whole = {"revision": 1, "strokes": [], "drops_objects": True, "removed_count": 0, "created_at": None}
    return [
        ScanCropOut.model_validate(
            (whole if row is None else {name: getattr(row, name) for name in names})
            | {
                "metres_per_unit": find_revision_unit(scan, row),
                "author_name": None if row is None else people.get(row.author_id),
            }
        )
        for row in rows
    ]

"""`/registrations`."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Response

from server.access.service import AccountIdDep
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.download import name_download
from server.errors import error_responses
from server.registrations import service
from server.registrations.schemas import Order, Queue, RegistrationCounts, RegistrationOut, Standing
from server.registrations.service import RegistrationFilter
from server.scans.geometry import MEDIA_TYPE
from server.scans.routes import GEOMETRY, IMMUTABLE
from server.scans.schemas import Verdict
from server.scans.service import get_scan
from server.storage import StorageDep

router = APIRouter(prefix="/registrations", tags=["registrations"], responses=error_responses())


async def get_filter(
    scan_id: uuid.UUID | None = None,
    model_id: uuid.UUID | None = None,
    job_id: uuid.UUID | None = None,
    round: Annotated[int | None, Query(ge=1, le=1000)] = None,
    collection: Annotated[str | None, Query(max_length=200)] = None,
    subject: Annotated[str | None, Query(max_length=100)] = None,
    verdict: Verdict | None = None,
    decision: Annotated[Standing | None, Query(description="The last one that stands and is not hidden.")] = None,
    all_rounds: Annotated[bool, Query(description="Also those that a newer one of the scan has followed.")] = False,
) -> RegistrationFilter:
    """Which registrations are asked for."""
    return RegistrationFilter(scan_id, model_id, job_id, round, collection, subject, verdict, decision, all_rounds)


FilterDep = Annotated[RegistrationFilter, Depends(get_filter)]


@router.get("")
def list_registrations(
    wanted: FilterDep,
    session: SessionDep,
    account_id: AccountIdDep,
    queue: Annotated[
        Queue,
        Query(
            description="`undecided`: nobody has decided; `flagged`: the program doubts them, or somebody is unsure; "
            "`second`: you are to decide without seeing what somebody else decided."
        ),
    ] = "all",
    order: Order = "newest",
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[RegistrationOut]:
    """Registrations; of each scan the newest one, unless a scan, a job or all rounds are asked for."""
    rows, next_cursor = service.list_registrations(session, wanted, queue, order, account_id, cursor, limit)
    return Page(items=service.describe_registrations(session, rows, account_id), next_cursor=next_cursor)


@router.get("/counts")
def count_registrations(wanted: FilterDep, session: SessionDep, account_id: AccountIdDep) -> RegistrationCounts:
    """How many registrations are in each queue."""
    return service.count_registrations(session, wanted, account_id)


@router.get("/{registration_id}", responses=error_responses(404))
def get_registration(registration_id: uuid.UUID, session: SessionDep, account_id: AccountIdDep) -> RegistrationOut:
    """One registration."""
    row = service.get_registration(session, registration_id)
    return service.describe_registrations(session, [row], account_id)[0]


@router.get("/{registration_id}/geometry", response_class=Response, responses=GEOMETRY | error_responses(404))
def get_registration_geometry(
    registration_id: uuid.UUID,
    session: SessionDep,
    storage: StorageDep,
    size: Annotated[int, Query(ge=1, le=200_000, description="As the scan's geometry was asked for.")] = 20_000,
) -> Response:
    """The registered mesh with the error of each vertex, and of each point of the scan's geometry. It never changes."""
    row = service.get_registration(session, registration_id)
    digest = get_scan(session, row.scan_id, deleted_too=True).digest
    data = service.pack_registration(storage, row, digest, size)
    return Response(data, media_type=MEDIA_TYPE, headers={"Cache-Control": IMMUTABLE})


@router.get(
    "/{registration_id}/registration.npz",
    response_class=Response,
    responses=error_responses(404)
    | {200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}},
)
def download_registration(registration_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> Response:
    """The file, as `handloom register` writes it."""
    row = service.get_registration(session, registration_id)
    data = (storage.folder(service.AREA, row.id) / service.FILE).read_bytes()
    scan = get_scan(session, row.scan_id, deleted_too=True)
    headers = name_download(scan.name, "registration", row.digest[:12], suffix=".npz")
    return Response(data, media_type="application/octet-stream", headers=headers | {"ETag": f'"{row.digest}"'})

"""What can be done with registrations that are there."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from sqlalchemy import ColumnElement, Select, and_, func, not_, or_, select
from sqlalchemy.orm import Session

from server.database.paging import fetch_page
from server.errors import NotFoundError
from server.hand_models.models import HandModelRow
from server.registrations.models import RegistrationRow
from server.registrations.schemas import (
    Order,
    Queue,
    RegistrationCounts,
    RegistrationOut,
    RegistrationScan,
    ScanToMesh,
)
from server.scans.geometry import choose_points, pack_arrays
from server.scans.models import ScanRow
from server.scans.service import list_crops, write_geometry_key
from server.scans.units import find_revision_unit
from server.storage import Storage

AREA = "registrations"
FILE, ERRORS = "registration.npz", "errors.npz"
"""What the registration writes, and the errors by vertex and by point that go with it."""


@dataclass(frozen=True)
class RegistrationFilter:
    """Which registrations are asked for; what is None asks for nothing.

    Attributes:
        all_rounds: Also those that a newer one of the same scan has followed.
    """

    scan_id: uuid.UUID | None = None
    model_id: uuid.UUID | None = None
    job_id: uuid.UUID | None = None
    round: int | None = None
    collection: str | None = None
    subject: str | None = None
    verdict: str | None = None
    decision: str | None = None
    all_rounds: bool = False

    def apply(self, query: Select[Any], account_id: uuid.UUID) -> Select[Any]:
        query = query.join(ScanRow, ScanRow.id == RegistrationRow.scan_id).where(ScanRow.deleted_at.is_(None))
        for name in ("scan_id", "model_id", "job_id", "round", "verdict"):
            if (wanted := getattr(self, name)) is not None:
                query = query.where(getattr(RegistrationRow, name) == wanted)
        for name in ("collection", "subject"):
            if (wanted := getattr(self, name)) is not None:
                query = query.where(getattr(ScanRow, name) == wanted)
        if self.decision is not None:
            query = query.where(RegistrationRow.decision == self.decision, not_(is_hidden_from(account_id)))
        if not (self.all_rounds or self.scan_id or self.job_id):
            query = query.where(RegistrationRow.is_current)
        return query


def is_hidden_from(account_id: uuid.UUID) -> ColumnElement[bool]:
    """Registrations that this person is to decide about without seeing what somebody else has decided."""
    return and_(
        RegistrationRow.needs_second,
        RegistrationRow.reviewer_count == 1,
        RegistrationRow.sole_reviewer_id != account_id,
    )


def is_hidden(row: RegistrationRow, account_id: uuid.UUID) -> bool:
    """The same, of one row."""
    return row.needs_second and row.reviewer_count == 1 and row.sole_reviewer_id != account_id


def in_queue(queue: Queue, account_id: uuid.UUID) -> ColumnElement[bool]:
    """Registrations of a queue."""
    if queue == "undecided":
        return RegistrationRow.reviewer_count == 0
    if queue == "second":
        return is_hidden_from(account_id)
    if queue == "flagged":
        unsure = and_(RegistrationRow.decision == "unsure", not_(is_hidden_from(account_id)))
        return or_(RegistrationRow.verdict != "good", unsure)
    return RegistrationRow.id.is_not(None)


def list_registrations(
    session: Session,
    wanted: RegistrationFilter,
    queue: Queue,
    order: Order,
    account_id: uuid.UUID,
    cursor: str | None,
    limit: int,
) -> tuple[Sequence[RegistrationRow], str | None]:
    """A page of a queue. Who decides about what they see finds the rest by the cursor all the same."""
    query = wanted.apply(select(RegistrationRow), account_id).where(in_queue(queue, account_id))
    column = RegistrationRow.score if order == "likely_failures" else RegistrationRow.created_at
    return fetch_page(session, query, (column, RegistrationRow.id), cursor, limit)


def count_registrations(session: Session, wanted: RegistrationFilter, account_id: uuid.UUID) -> RegistrationCounts:
    """How much there is in each queue."""
    shown = not_(is_hidden_from(account_id))
    counts: dict[str, ColumnElement[int]] = {
        queue: func.count().filter(in_queue(queue, account_id)) for queue in ("undecided", "flagged", "second")
    }
    counts["all"] = func.count()
    for decision in ("accept", "reject", "unsure"):
        counts[decision] = func.count().filter(RegistrationRow.decision == decision, shown)
    columns: Select[Any] = select(*counts.values())  # pyright: ignore[reportAssignmentType]
    query = wanted.apply(columns.select_from(RegistrationRow), account_id)
    return RegistrationCounts.model_validate(dict(zip(counts, session.execute(query).one(), strict=True)))


def get_registration(session: Session, registration_id: uuid.UUID, *, hold: bool = False) -> RegistrationRow:
    """The registration of this id; with `hold` nobody else decides about it until the transaction ends."""
    query = select(RegistrationRow).where(RegistrationRow.id == registration_id)
    if hold:
        query = query.with_for_update().execution_options(populate_existing=True)
    row = session.scalars(query).one_or_none()
    if row is None:
        raise NotFoundError(f"There is no registration {registration_id}.")
    return row


def add_registration(session: Session, row: RegistrationRow) -> RegistrationRow:
    """Store a registration as the newest one of its scan; the row that is there when this was done before."""
    known = session.get(RegistrationRow, row.id) if row.id else None
    if known is not None:
        return known
    session.add(row)
    session.flush()
    settle_current(session, session.get_one(ScanRow, row.scan_id, with_for_update=True, populate_existing=True))
    return row


def settle_current(session: Session, scan: ScanRow) -> None:
    """See which registrations of a scan were made at the size that it has now; the newest of these is the current one.

    Called when there is a new one, and when somebody corrects the unit of the scan.
    """
    units = {1: scan.first_metres_per_unit}
    units |= {row.revision: find_revision_unit(scan, row) for row in list_crops(session, scan.id)}
    query = select(RegistrationRow).where(RegistrationRow.scan_id == scan.id)
    is_found = False
    for row in session.scalars(query.order_by(RegistrationRow.created_at.desc(), RegistrationRow.id)).all():
        row.is_outdated = units[row.crop_revision] != scan.metres_per_unit
        row.is_current = not (row.is_outdated or is_found)
        is_found |= row.is_current
    if is_found:
        scan.state, scan.problem = "registered", None
    session.flush()


def find_newest(session: Session, scan_ids: Sequence[uuid.UUID]) -> dict[uuid.UUID, dict[str, Any]]:
    """For each scan with registrations its `registration`: the newest one, in brief."""
    query = select(RegistrationRow).where(RegistrationRow.scan_id.in_(scan_ids), RegistrationRow.is_current)
    brief = ("id", "verdict", "score", "round", "model_id")
    return {
        row.scan_id: {"registration": {name: getattr(row, name) for name in brief}} for row in session.scalars(query)
    }


def describe_registrations(
    session: Session, rows: Sequence[RegistrationRow], account_id: uuid.UUID
) -> list[RegistrationOut]:
    """Registrations as the API gives them to somebody: two queries, however many they are."""
    if not rows:
        return []
    scans = {row.id: row for row in session.scalars(select(ScanRow).where(ScanRow.id.in_({r.scan_id for r in rows})))}
    query = select(HandModelRow.id, HandModelRow.name).where(HandModelRow.id.in_({row.model_id for row in rows}))
    models = {model.id: model.name for model in session.execute(query)}
    return [_describe(row, scans[row.scan_id], models[row.model_id], account_id) for row in rows]


def _describe(row: RegistrationRow, scan: ScanRow, model_name: str, account_id: uuid.UUID) -> RegistrationOut:
    mine = row.standing.get(str(account_id))
    hidden = is_hidden(row, account_id)
    own = ("id", "model_id", "job_id", "round", "side", "verdict", "score", "reasons", "seconds")
    more = ("is_current", "is_outdated", "reviewer_count", "needs_second", "created_at")
    return RegistrationOut.model_validate(
        {name: getattr(row, name) for name in own + more}
        | {
            "scan": RegistrationScan(
                id=scan.id,
                name=scan.name,
                collection=scan.collection,
                subject=scan.subject,
                pose=scan.pose,
                side="right" if scan.side == "right" else "left" if scan.side == "left" else None,
                point_count=scan.point_count,
                geometry_key=write_geometry_key(scan.digest, row.crop_revision),
            ),
            "model_name": model_name,
            "scan_to_mesh_mm": ScanToMesh.model_validate(row.scan_to_mesh_mm),
            "decision": None if hidden else row.decision,
            "is_hidden": hidden,
            "my_decision": mine["decision"] if mine else None,
            "my_decision_id": mine["id"] if mine else None,
        }
    )


def pack_registration(storage: Storage, row: RegistrationRow, digest: str, size: int) -> bytes:
    """A registered mesh for the browser, with its errors and those of the scan's points.

    Args:
        storage: Where the files are.
        row: Which.
        digest: Of the scan.
        size: As the scan's own geometry is asked for: the errors are those of the same points.
    """
    folder = storage.folder(AREA, row.id)
    with np.load(folder / FILE, allow_pickle=False) as file:
        vertices, model_vertices = file["vertices"], file["model_vertices"]
        faces = file["faces"]
    with np.load(folder / ERRORS, allow_pickle=False) as file:
        vertex_error, point_error = file["vertex_error_mm"], file["point_error_mm"]
    chosen = choose_points(len(point_error), size, digest)
    arrays = {
        "vertices": vertices.astype(np.float32),
        "model_vertices": model_vertices.astype(np.float32),
        "faces": faces.astype(np.uint32),
        "vertex_error_mm": vertex_error.astype(np.float32),
        "point_error_mm": point_error[chosen].astype(np.float32),
    }
    return pack_arrays(arrays, {"side": row.side})

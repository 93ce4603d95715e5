"""Accepted frames that are kept: a set that never changes, and what other programs take of it."""

from __future__ import annotations

import hashlib
import json
import uuid
from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.service import find_names
from server.database.paging import fetch_page
from server.errors import InvalidError, NotFoundError
from server.moving_scans.accepted import Accepted, describe_stretches, find_accepted
from server.moving_scans.decision_schemas import AcceptedFrames, BodySetMake, BodySetOut
from server.moving_scans.models import BodySetRow, FrameRegistrationRow, MovingScanRow


def describe_accepted(session: Session, moving_scan_id: uuid.UUID) -> AcceptedFrames:
    """What of a moving scan is accepted now."""
    accepted = find_accepted(session, moving_scan_id)
    return AcceptedFrames(frame_count=len(accepted), stretches=describe_stretches(session, accepted))


def create_body_set(
    session: Session, scan: MovingScanRow, made: BodySetMake, account_id: uuid.UUID
) -> tuple[BodySetRow, bool]:
    """Keep what is accepted now. Gives the set, and whether it is new: the same registrations are kept once."""
    members = [
        {
            "frame": each.frame,
            "frame_registration_id": str(each.frame_registration_id),
            "digest": each.digest,
            "decision_id": str(each.decision_id),
        }
        for each in find_accepted(session, scan.id)
    ]
    if not members:
        raise InvalidError(f"No frame of “{scan.name}” is accepted. Accept a stretch of a registration first.")
    digest = hashlib.sha256(json.dumps(members, sort_keys=True).encode()).hexdigest()
    if (known := _find(session, scan.id, digest)) is not None:
        return known, False
    row = BodySetRow(
        moving_scan_id=scan.id,
        name=made.name,
        digest=digest,
        frame_count=len(members),
        members=members,
        created_by=account_id,
    )
    try:
        with session.begin_nested():
            session.add(row)
            session.flush()
    except IntegrityError:  # somebody keeps the same at this very moment
        known = _find(session, scan.id, digest)
        assert known is not None
        return known, False
    record_act(session, account_id, "body_set.make", "body_set", row.id, frames=len(members))
    return row, True


def get_body_set(session: Session, id_: uuid.UUID) -> BodySetRow:
    """The set of this id."""
    row = session.get(BodySetRow, id_)
    if row is None:
        raise NotFoundError(f"There is no set of accepted frames {id_}.")
    return row


def list_body_sets(
    session: Session, moving_scan_id: uuid.UUID | None, cursor: str | None, limit: int
) -> tuple[Sequence[BodySetRow], str | None]:
    """The newest first."""
    query = select(BodySetRow)
    if moving_scan_id is not None:
        query = query.where(BodySetRow.moving_scan_id == moving_scan_id)
    return fetch_page(session, query, (BodySetRow.created_at, BodySetRow.id), cursor, limit)


def read_members(session: Session, row: BodySetRow) -> list[Accepted]:
    """The frames of a set, in order."""
    ids = [uuid.UUID(member["frame_registration_id"]) for member in row.members]
    query = select(FrameRegistrationRow).where(FrameRegistrationRow.id.in_(ids))
    frames = {frame.id: frame for frame in session.scalars(query)}
    return [
        Accepted(member["frame"], id_, member["digest"], frames[id_].registration_id, uuid.UUID(member["decision_id"]))
        for id_, member in zip(ids, row.members, strict=True)
    ]


def describe_body_sets(session: Session, rows: Sequence[BodySetRow]) -> list[BodySetOut]:
    """Sets as the API gives them."""
    people = find_names(session, (row.created_by for row in rows))
    own = BodySetOut.model_fields.keys() - {"stretches", "created_by_name"}
    return [
        BodySetOut.model_validate(
            {name: getattr(row, name) for name in own}
            | {
                "stretches": describe_stretches(session, read_members(session, row)),
                "created_by_name": people.get(row.created_by),
            }
        )
        for row in rows
    ]


def _find(session: Session, moving_scan_id: uuid.UUID, digest: str) -> BodySetRow | None:
    query = select(BodySetRow).where(BodySetRow.moving_scan_id == moving_scan_id, BodySetRow.digest == digest)
    return session.scalars(query).one_or_none()

"""Which scans a job registers."""

from __future__ import annotations

import uuid

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.errors import NotFoundError
from server.hand_models.storing import UNTRAINED_ID
from server.jobs.loop_schemas import LoopCreate
from server.jobs.register_schemas import RegisterCreate
from server.registrations.models import RegistrationRow
from server.scans.models import ScanRow
from tracker import say_count

AT_ONCE = 500


def list_loop_scans(session: Session, asked: LoopCreate) -> list[uuid.UUID]:
    """Those that a loop goes over."""
    everything = RegisterCreate(collection=asked.collection, only="all")
    return choose_scans(session, everything, asked.model_id or UNTRAINED_ID)


def choose_scans(session: Session, asked: RegisterCreate, model_id: uuid.UUID) -> list[uuid.UUID]:
    """By name, so that what one sees grow is in order."""
    query = select(ScanRow.id).where(ScanRow.deleted_at.is_(None)).order_by(ScanRow.name, ScanRow.id)
    if asked.collection is not None:
        query = query.where(ScanRow.collection == asked.collection)
    if asked.subject is not None:
        query = query.where(ScanRow.subject == asked.subject)
    newest = select(RegistrationRow.id).where(RegistrationRow.scan_id == ScanRow.id)
    if asked.only == "new":
        done = newest.where(RegistrationRow.model_id == model_id, RegistrationRow.crop_revision == ScanRow.revision)
        query = query.where(~done.exists())
    elif asked.only == "not_accepted":
        query = query.where(~newest.where(RegistrationRow.is_current, RegistrationRow.decision == "accept").exists())
    if not asked.scan_ids:
        return list(session.scalars(query))
    wanted = list(dict.fromkeys(asked.scan_ids))
    there: set[uuid.UUID] = set()
    for first in range(0, len(wanted), AT_ONCE):
        some = wanted[first : first + AT_ONCE]
        there |= set(session.scalars(select(ScanRow.id).where(ScanRow.id.in_(some), ScanRow.deleted_at.is_(None))))
    if missing := [id_ for id_ in wanted if id_ not in there]:
        more = f", nor {say_count(len(missing) - 1, 'other')}" if len(missing) > 1 else ""
        raise NotFoundError(f"There is no scan {missing[0]}{more}.")
    return [id_ for id_ in session.scalars(query) if id_ in there]

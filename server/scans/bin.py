"""Scans in the bin."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.accounts.audit import record_act
from server.accounts.models import Account
from server.bin.kinds import BinKind
from server.scans import service
from server.scans.models import ScanRow


def _restore(session: Session, account: Account, id_: uuid.UUID) -> None:
    service.restore_scan(session, service.get_scan(session, id_, deleted_too=True))
    record_act(session, account.id, "scan.restore", "scan", id_)


SCANS = BinKind(
    kind="scan",
    word="scan",
    id=ScanRow.id,
    name=ScanRow.name,
    deleted_at=ScanRow.deleted_at,
    restore=_restore,
    area=service.AREA,
)

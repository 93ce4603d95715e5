"""Recordings in the bin."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.accounts.audit import record_act
from server.accounts.models import Account
from server.bin.kinds import BinKind
from server.sequences import service
from server.sequences.models import SequenceRow


def _restore(session: Session, account: Account, id_: uuid.UUID) -> None:
    service.restore_sequence(session, service.get_sequence(session, id_, deleted_too=True))
    record_act(session, account.id, "recording.restore", "recording", id_)


RECORDINGS = BinKind(
    kind="recording",
    word="recording",
    id=SequenceRow.id,
    name=SequenceRow.name,
    deleted_at=SequenceRow.deleted_at,
    restore=_restore,
    area=service.AREA,
)

"""Hand models in the bin."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.accounts.audit import record_act
from server.accounts.models import Account
from server.bin.kinds import BinKind
from server.hand_models import service
from server.hand_models.models import HandModelRow


def _restore(session: Session, account: Account, id_: uuid.UUID) -> None:
    service.restore_hand_model(session, service.get_hand_model(session, id_, deleted_too=True))
    record_act(session, account.id, "hand_model.restore", "hand_model", id_)


HAND_MODELS = BinKind(
    kind="hand_model",
    word="hand model",
    id=HandModelRow.id,
    name=HandModelRow.name,
    deleted_at=HandModelRow.deleted_at,
    restore=_restore,
    area=service.AREA,
)

"""Tracks in the bin."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.accounts.audit import record_act
from server.accounts.models import Account
from server.bin.kinds import BinKind
from server.tracks import service
from server.tracks.models import TrackRow


def _restore(session: Session, account: Account, id_: uuid.UUID) -> None:
    service.restore_track(session, id_)
    record_act(session, account.id, "track.restore", "track", id_)


TRACKS = BinKind(
    kind="track",
    word="track",
    id=TrackRow.id,
    name=TrackRow.name,
    deleted_at=TrackRow.deleted_at,
    restore=_restore,
    parent=("recording", TrackRow.sequence_id),
    area="tracks",
)

"""Who must not look into a track. The rooms that know stand above this one, so the app hands their answers in."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from typing import Annotated

from fastapi import Depends
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.access.models import Account
from server.access.service import CurrentAccount
from server.database import DatabaseDep
from server.tracks.models import TrackRow
from server.tracks.service import get_track

SightGuard = Callable[[Session, Account, uuid.UUID], None]
"""Raises when the account must not see what was tracked in a recording."""


async def get_sight_guards(connection: HTTPConnection) -> tuple[SightGuard, ...]:
    """Those the app was put together with."""
    return connection.app.state.sight_guards


SightDep = Annotated[tuple[SightGuard, ...], Depends(get_sight_guards)]


def check_sight(guards: Sequence[SightGuard], session: Session, account: Account, sequence_id: uuid.UUID) -> None:
    """Raise when the account must not see what was tracked in the recording."""
    for guard in guards:
        guard(session, account, sequence_id)


def get_seen_track(track_id: uuid.UUID, database: DatabaseDep, account: CurrentAccount, guards: SightDep) -> TrackRow:
    """The track of the address, if whoever asks may look into it."""
    with database.reading() as session:
        track = get_track(session, track_id)
        check_sight(guards, session, account, track.sequence_id)
    return track


SeenTrack = Annotated[TrackRow, Depends(get_seen_track)]

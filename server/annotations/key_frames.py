"""Key frames: annotations between which a machine may propose the rest. Everybody who sees the labels sees them."""

from __future__ import annotations

import uuid
from collections.abc import Sequence

from sqlalchemy import delete, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.places import HiddenPlaces, Place
from server.annotations.models import KeyFrameRow

MAX_KEY_FRAMES = 100_000
"""Of one recording; more are no help."""


def list_key_frames(
    session: Session, sequence_id: uuid.UUID, replica: str = "", hidden: Sequence[HiddenPlaces] = ()
) -> list[KeyFrameRow]:
    """Of a recording or a blind replica, by frame; those at hidden places are left out."""
    query = (
        select(KeyFrameRow)
        .where(KeyFrameRow.sequence_id == sequence_id, KeyFrameRow.replica == replica)
        .order_by(KeyFrameRow.frame, KeyFrameRow.camera, KeyFrameRow.hand)
        .limit(MAX_KEY_FRAMES)
    )

    def is_hidden(row: KeyFrameRow) -> bool:
        place = Place(row.sequence_id, row.camera, row.frame, row.hand, row.replica)
        return any(place in places for places in hidden)

    return [row for row in session.scalars(query) if not is_hidden(row)]


def add_key_frame(session: Session, place: Place, account_id: uuid.UUID) -> None:
    """Make it one; twice does no harm."""
    if _find(session, place) is not None:
        return
    try:
        with session.begin_nested():
            session.add(KeyFrameRow(**vars(place), created_by=account_id))
            session.flush()
    except IntegrityError:  # somebody else made it one between our look and now
        return


def remove_key_frame(session: Session, place: Place) -> None:
    """It is none any more; twice does no harm."""
    session.execute(delete(KeyFrameRow).where(KeyFrameRow.id == _find(session, place)))


def _find(session: Session, place: Place) -> uuid.UUID | None:
    return session.scalar(select(KeyFrameRow.id).filter_by(**vars(place)))

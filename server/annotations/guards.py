"""What other rooms forbid at a place. Those rooms stand above this one, so the app hands their answers in."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.access.models import Account
from server.annotations.service import HiddenPlaces, Place
from server.errors import ForbiddenError


@dataclass(frozen=True)
class PlaceGuard:
    """A room's say in who reads and changes what.

    Attributes:
        check_change: Raises when the account must not change the place; called inside the writing transaction.
        find_hidden: Of a recording's replica (empty: what everybody sees), the places that the account must not read;
            raises when it must read none.
    """

    check_change: Callable[[Session, Account, Place], None]
    find_hidden: Callable[[Session, Account, uuid.UUID, str], Sequence[HiddenPlaces]]


async def get_place_guards(connection: HTTPConnection) -> tuple[PlaceGuard, ...]:
    """Those the app was put together with."""
    return connection.app.state.place_guards


GuardsDep = Annotated[tuple[PlaceGuard, ...], Depends(get_place_guards)]


def check_change(guards: Sequence[PlaceGuard], session: Session, account: Account, place: Place) -> None:
    """Raise when the account must not change the place."""
    for guard in guards:
        guard.check_change(session, account, place)


def find_hidden(
    guards: Sequence[PlaceGuard], session: Session, account: Account, sequence_id: uuid.UUID, replica: str = ""
) -> list[HiddenPlaces]:
    """Places of a recording that the account must not read; raises when it must read none."""
    return [places for guard in guards for places in guard.find_hidden(session, account, sequence_id, replica)]


def check_read(guards: Sequence[PlaceGuard], session: Session, account: Account, place: Place) -> None:
    """Raise when the account must not read the place."""
    if any(place in hidden for hidden in find_hidden(guards, session, account, place.sequence_id, place.replica)):
        raise ForbiddenError(
            f"You mark {place} blindly, so nobody else's joints are shown to you there until your work is accepted."
        )

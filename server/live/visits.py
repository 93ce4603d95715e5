"""Who has which recording open, and at which frame. Kept in memory: it is true only as long as the server runs."""

from __future__ import annotations

import time
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from threading import Lock

from server.live.schemas import PersonHere

SILENCE_SECONDS = 25.0
"""A page says every 10 s where it is; whoever was not heard for so long has gone."""

MOST_VISITS = 30
"""Of one account; older ones are forgotten."""


@dataclass(frozen=True)
class Visit:
    """A page in which somebody has a recording open."""

    sequence_id: uuid.UUID
    account_id: uuid.UUID
    name: str
    camera: str
    frame: int
    hand: str

    @cached_property
    def text(self) -> str:
        """A PersonHere in JSON, written once for all who hear of it."""
        return PersonHere.model_validate(self, from_attributes=True).model_dump_json()


class Visits:
    """All visits that this process serves; one for each app."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._lock = Lock()
        self._visits: dict[tuple[uuid.UUID, uuid.UUID], tuple[Visit, float]] = {}
        self._streams: dict[tuple[uuid.UUID, uuid.UUID], int] = {}

    def put(self, id_: uuid.UUID, visit: Visit) -> None:
        """Note where somebody is. The id is the page's own and means nothing in anybody else's name."""
        with self._lock:
            self._visits.pop((visit.account_id, id_), None)
            self._visits[visit.account_id, id_] = visit, self._now()
            own = [key for key in self._visits if key[0] == visit.account_id]
            for key in own[:-MOST_VISITS]:
                del self._visits[key]

    def arrive(self, account_id: uuid.UUID, id_: uuid.UUID) -> None:
        """The page of a visit has opened its stream."""
        with self._lock:
            self._streams[account_id, id_] = self._streams.get((account_id, id_), 0) + 1

    def leave(self, account_id: uuid.UUID, id_: uuid.UUID) -> None:
        """A stream has ended; with the last one of its page the visit is over."""
        key = account_id, id_
        with self._lock:
            self._streams[key] = self._streams.get(key, 1) - 1
            if self._streams[key] <= 0:
                del self._streams[key]
                self._visits.pop(key, None)

    def find_others(self, sequence_id: uuid.UUID, account_id: uuid.UUID) -> list[Visit]:
        """Everybody else in a recording, by name; somebody with several pages is where they moved last."""
        heard_since = self._now() - SILENCE_SECONDS
        with self._lock:
            for key in [key for key, (_, seen) in self._visits.items() if seen < heard_since]:
                del self._visits[key]
            newest = {
                visit.account_id: visit
                for visit, _ in self._visits.values()
                if visit.sequence_id == sequence_id and visit.account_id != account_id
            }
        return sorted(newest.values(), key=lambda visit: visit.name)

"""What one listener hears of a recording that it has open."""

from __future__ import annotations

import hashlib
import uuid
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from server.access.models import Account
from server.access.places import HiddenPlaces
from server.access.policy import find_hidden
from server.annotations.key_frames import list_key_frames
from server.annotations.schemas import KeyFrame, KeyFrames
from server.database import Database
from server.errors import StudioError
from server.jobs.events import AllJobsFeed, encode_event
from server.live.schemas import Sight, Work
from server.live.visits import Visit, Visits
from server.live.watch import Changed, Look, RecordingWatch, load_since

_SEPARATOR = "~"


@dataclass(frozen=True)
class Listener:
    """Who listens, and to which of a recording's versions: everybody's (empty) or a blind replica."""

    account: Account
    replica: str
    visit_id: uuid.UUID | None = None


@dataclass
class RecordingFeed:
    """Changes of a recording, with those of all jobs, so that a page needs one stream and no more.

    An id is `<jobs>~<labels>`: the times up to which the listener has heard of either.
    """

    watch: RecordingWatch
    visits: Visits
    listener: Listener
    since: datetime | None
    jobs: AllJobsFeed
    has_ended: bool = False
    _number: int | None = None
    _revisions: dict[Any, int] = field(default_factory=dict)
    _hidden: Sequence[HiddenPlaces] = ()
    _digest: str | None = None
    _work: tuple[Any, ...] | None = None
    _keys: tuple[Any, ...] | None = None
    _jobs: tuple[Any, ...] | None = None
    _people: list[Visit] | None = None
    _state: object = None

    @classmethod
    def after(
        cls,
        last_event_id: str | None,
        watch: RecordingWatch,
        visits: Visits,
        listener: Listener,
    ) -> RecordingFeed:
        """Go on after the event whose id the listener had last, from now on when it makes no sense."""
        jobs, _, labels = (last_event_id or "").partition(_SEPARATOR)
        try:
            heard = datetime.fromisoformat(labels)
        except ValueError:
            heard = None
        since = heard if heard is not None and heard.tzinfo is not None else None
        if listener.visit_id is not None:
            visits.arrive(listener.account.id, listener.visit_id)
        return cls(watch, visits, listener, since, AllJobsFeed.after(jobs))

    def close(self) -> None:
        """The listener has gone."""
        if self.listener.visit_id is not None:
            self.visits.leave(self.listener.account.id, self.listener.visit_id)

    def is_quiet(self) -> bool:
        return self.watch.is_quiet(self._state) and self._find_people() == self._people

    def poll(self, database: Database) -> list[str]:
        look = self.watch.look(database, self._number or 0)
        try:
            events = self._read(database, look)
        except StudioError:  # the recording or the replica is not to be read any more
            self.has_ended = True
            return []
        if look.jobs != self._jobs:
            self._jobs = look.jobs
            events += [("job", job.model_dump_json()) for job in self.jobs.find_changes(database)]
        self.has_ended, self._state = look.is_gone, look.state
        id_ = f"{self.jobs.since.isoformat() if self.jobs.since else ''}{_SEPARATOR}{look.looked_at.isoformat()}"
        return [encode_event(name, data, id_) for name, data in events]

    def _read(self, database: Database, look: Look) -> list[tuple[str, str]]:
        events: list[tuple[str, str]] = []
        if look.work != self._work:
            events += self._see(database)
            if self._work is not None:
                events.append(("work", Work().model_dump_json()))
            self._work = look.work
        changes = look.changes
        if self._number is None or changes is None:
            changes = []
            if self.since is not None:
                with database.reading() as session:
                    changes = load_since(session, self.watch.sequence_id, self.since)
        self._number, self.since = look.number, look.looked_at
        events += [("label", changed.text) for changed in changes if self._is_news(changed)]
        if look.keys != self._keys:
            self._keys = look.keys
            events.append(("keys", self._find_keys(database).model_dump_json()))
        people = self._find_people()
        if people != self._people:
            self._people = people
            texts = ",".join(visit.text for visit in people)
            events.append(("people", f'{{"items":[{texts}]}}'))
        return events

    def _see(self, database: Database) -> list[tuple[str, str]]:
        """What the listener must not read may be other places now."""
        with database.reading() as session:
            self._hidden = find_hidden(session, self.listener.account, self.watch.sequence_id, self.listener.replica)
        places = sorted((sorted(one.frames), sorted(one.cameras), sorted(one.hands)) for one in self._hidden)
        digest = hashlib.sha256(repr(places).encode()).hexdigest()[:16]
        if digest == self._digest:
            return []
        self._digest = digest
        return [("sight", Sight(digest=digest).model_dump_json())]

    def _is_news(self, changed: Changed) -> bool:
        place = changed.place
        if place.replica != self.listener.replica or any(place in hidden for hidden in self._hidden):
            return False
        if self._revisions.get(place, 0) >= changed.revision:
            return False
        self._revisions[place] = changed.revision
        return True

    def _find_keys(self, database: Database) -> KeyFrames:
        with database.reading() as session:
            rows = list_key_frames(session, self.watch.sequence_id, self.listener.replica, self._hidden)
            return KeyFrames(items=[KeyFrame.model_validate(row) for row in rows])

    def _find_people(self) -> list[Visit]:
        """Nobody for who marks blindly: who works where is nothing that they should know of."""
        if self.listener.replica or self._hidden:
            return []
        return self.visits.find_others(self.watch.sequence_id, self.listener.account.id)

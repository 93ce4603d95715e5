"""Flags of a recording's labels as they are now, and what people said of them."""

from __future__ import annotations

import threading
import time
import uuid
from collections import OrderedDict
from collections.abc import AsyncIterator, Mapping
from collections.abc import Sequence as Many
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from anyio import CapacityLimiter
from fastapi import Depends
from sqlalchemy import delete, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.access.places import HiddenPlaces, Place
from server.access.policy import find_hidden
from server.access.service import CurrentAccount
from server.annotations.models import AnnotationRow
from server.annotations.service import find_revisions, get_annotation, list_annotations
from server.database import AdmissionDep, Database
from server.errors import ConflictError
from server.jobs.detections import AREA, find_detections
from server.quality.doubt import Doubt
from server.quality.find import Coverage, LabelCheck, Setting, check_labels
from server.quality.finding import Finding
from server.quality.labels import Label, LabelReader
from server.quality.models import DismissalRow
from server.quality.queue import find_doubts, find_label_doubts
from server.quality.witnesses import read_detections, read_track
from server.sequences.service import get_sequence
from server.storage import Storage
from server.tracks.best_tracks import find_best_tracks
from server.tracks.service import get_track

if TYPE_CHECKING:
    from tracker import Sequence

KEPT = 16
"""Recordings whose flags are remembered."""

SHARE, CREDIT_SECONDS = 0.1, 3.0
"""Checks of a recording may take this part of a processor, and so many seconds at once after a rest."""


@dataclass(frozen=True)
class Compared:
    """The track that labels are compared with."""

    id: uuid.UUID
    name: str


@dataclass(frozen=True)
class Flagged:
    """A recording's labels as the checks saw them.

    Attributes:
        findings: What looked wrong, the worst first, of labels that are still as they were.
        doubts: What else speaks for looking at a hand, labelled or not; none where they were not asked for.
        setting: What the labels were compared with.
        is_behind: Labels have changed since.
    """

    labels: Many[Label]
    findings: Many[Finding]
    coverage: Many[Coverage]
    doubts: Many[Doubt]
    setting: Setting
    is_behind: bool


@dataclass(frozen=True)
class _Known:
    """An outcome. Doubts are found once somebody asks for them; those of machines stay while labels change."""

    labels: list[Label]
    check: LabelCheck
    setting: Setting
    revisions: Mapping[uuid.UUID, int]
    done_at: float
    spent: float
    of_machines: Many[Doubt] | None = None
    of_labels: Many[Doubt] | None = None

    @property
    def still_spent(self) -> float:
        """Seconds of a processor that are not made up for by rest yet."""
        return max(0.0, self.spent - SHARE * (time.monotonic() - self.done_at))

    def with_doubts(self) -> _Known:
        """The same, with all doubts."""
        if self.of_labels is not None:
            return self
        began, spent = time.monotonic(), self.still_spent
        of_machines = find_doubts(self.setting) if self.of_machines is None else self.of_machines
        of_labels = list(find_label_doubts(self.labels, self.setting))
        now = time.monotonic()
        return replace(self, of_machines=of_machines, of_labels=of_labels, done_at=now, spent=spent + now - began)

    def see(self, revisions: Mapping[uuid.UUID, int]) -> Flagged:
        """What of it still holds."""
        found = [one for one in self.check.findings if revisions.get(one.label.id) == one.label.revision]
        doubts = [
            one
            for one in (*(self.of_machines or ()), *(self.of_labels or ()))
            if one.label is None or revisions.get(one.label.id) == one.label.revision
        ]
        return Flagged(self.labels, found, self.check.coverage, doubts, self.setting, revisions != self.revisions)


class FlagFinder:
    """Finds flags of a recording's labels, and remembers them.

    Labels change while people work, and all their pages ask. Where checks would take more than a tenth of a processor,
    the last outcome is given again, and says that it is behind.
    """

    def __init__(self, storage: Storage) -> None:
        self._storage = storage
        self._reader = LabelReader()
        self._known: OrderedDict[tuple, _Known] = OrderedDict()
        self._lock = threading.Lock()

    def find(
        self,
        database: Database,
        sequence_id: uuid.UUID,
        content_key: str,
        hands: Many[str],
        track: Compared | None,
        with_doubts: bool = False,
    ) -> Flagged:
        """What the checks of the labels found and looked at; `track` is the one they are compared with, if any.

        Doubts are given only where they are asked for: they take as long again.
        """
        with database.reading() as session:
            job_id = find_detections(session, sequence_id)
        key = (sequence_id, content_key, tuple(hands), track, job_id)
        with self._lock:  # one at a time: several people open the same page
            with database.reading() as session:
                revisions = find_revisions(session, sequence_id)
            known = self._known.get(key)
            if known is None or (known.revisions != revisions and known.still_spent < CREDIT_SECONDS):
                known = self._check(database, key, known)
                revisions = known.revisions
            self._known[key] = known = known.with_doubts() if with_doubts else known
            while len(self._known) > KEPT:
                self._known.popitem(last=False)
            self._known.move_to_end(key)
        return known.see(revisions)

    def _check(
        self,
        database: Database,
        about: tuple[uuid.UUID, str, Many[str], Compared | None, uuid.UUID | None],
        before: _Known | None,
    ) -> _Known:
        from tracker import load_sequence

        sequence_id, _, hands, track, job_id = about
        began = time.monotonic()
        with database.reading() as session:
            rows, _ = list_annotations(session, sequence_id)
            session.expunge_all()
        recording = load_sequence(self._storage.folder("sequences", sequence_id))
        labels = self._read(recording, rows)
        setting = self._describe(recording, hands, track, job_id) if before is None else before.setting
        check = check_labels(labels, setting)
        spent = 0.0 if before is None else before.still_spent
        now = time.monotonic()
        revisions = {row.id: row.revision for row in rows}
        of_machines = None if before is None else before.of_machines
        return _Known(labels, check, setting, revisions, now, spent + now - began, of_machines)

    def _describe(
        self, recording: Sequence, hands: Many[str], track: Compared | None, job_id: uuid.UUID | None
    ) -> Setting:
        cameras = {camera.id: camera for camera in recording.cameras}
        setting = Setting(tuple(hands), dict(cameras), any(camera.has_depth for camera in cameras.values()))
        if job_id is not None:
            setting = replace(setting, detected=read_detections(self._storage.document(AREA, job_id)))
        if track is None:
            return setting
        missing = (
            f"{track.name} does not have this hand or frame, lost it, or the joints of the label came from a track"
        )
        tracked = read_track(self._storage.folder("tracks", track.id))
        return replace(setting, tracked=tracked, track_missing=missing)

    def _read(self, recording: Sequence, rows: Many[AnnotationRow]) -> list[Any]:
        cameras = {camera.id for camera in recording.cameras}
        return self._reader.read(recording, [row for row in rows if row.camera in cameras])


def find_compared(session: Session, sequence_id: uuid.UUID) -> Compared | None:
    """The recording's best track; None where it has none."""
    best = find_best_tracks(session, [sequence_id]).get(sequence_id)
    if best is None:
        return None
    row = get_track(session, best["best_track"]["id"])
    return Compared(row.id, row.name)


def find_dismissed(session: Session, sequence_id: uuid.UUID) -> set[tuple[uuid.UUID, int, str]]:
    """Label, revision and kind of every flag that was put away."""
    query = (
        select(DismissalRow.annotation_id, DismissalRow.revision, DismissalRow.kind)
        .join(AnnotationRow, AnnotationRow.id == DismissalRow.annotation_id)
        .where(AnnotationRow.sequence_id == sequence_id)
    )
    return {(id_, revision, kind) for id_, revision, kind in session.execute(query)}


def dismiss(session: Session, place: Place, kind: str, revision: int, account_id: uuid.UUID) -> None:
    """The label is right, says somebody who looked at this revision of it. Saying it twice does no harm."""
    row = get_annotation(session, place)
    if row.revision != revision:
        raise ConflictError(
            f"You looked at revision {revision} of {place}; it is at {row.revision} now. Look at it again."
        )
    try:
        with session.begin_nested():
            session.add(DismissalRow(annotation_id=row.id, revision=revision, kind=kind, account_id=account_id))
            session.flush()
    except IntegrityError:
        return  # somebody else has said so


def restore(session: Session, place: Place, kind: str, revision: int) -> None:
    """Undo the dismissal; nothing happens without one."""
    row = get_annotation(session, place)
    session.execute(
        delete(DismissalRow).where(
            DismissalRow.annotation_id == row.id, DismissalRow.revision == revision, DismissalRow.kind == kind
        )
    )


async def get_hidden(sequence_id: uuid.UUID, admission: AdmissionDep, account: CurrentAccount) -> list[HiddenPlaces]:
    """Places of the address's recording that whoever asks must not read."""

    def look(session: Session) -> list[HiddenPlaces]:
        get_sequence(session, sequence_id)
        return find_hidden(session, account, sequence_id)

    return await admission.read(look)


HiddenDep = Annotated[list[HiddenPlaces], Depends(get_hidden)]


async def wait_for_turn(connection: HTTPConnection) -> AsyncIterator[None]:
    """Two requests at a time have labels checked: suggestions find free threads beside them."""
    state = connection.app.state
    if not hasattr(state, "check_turns"):
        state.check_turns = CapacityLimiter(2)
    async with state.check_turns:
        yield


IN_TURN = Depends(wait_for_turn, scope="function")

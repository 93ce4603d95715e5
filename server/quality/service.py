"""Flags of a recording's labels as they are now, and what people said of them."""

from __future__ import annotations

import threading
import time
import uuid
from collections import OrderedDict
from collections.abc import AsyncIterator, Mapping
from collections.abc import Sequence as Many
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import numpy.typing as npt
from anyio import CapacityLimiter
from fastapi import Depends
from sqlalchemy import delete, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.annotations.models import AnnotationRow
from server.annotations.service import Place, find_revisions, get_annotation, list_annotations
from server.database import Database
from server.errors import ConflictError
from server.jobs.detections import AREA, find_detections
from server.quality.find import Coverage, LabelCheck, Setting, check_labels
from server.quality.finding import Finding
from server.quality.labels import Label, LabelReader
from server.quality.models import DismissalRow
from server.storage import Storage

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
        is_behind: Labels have changed since.
    """

    labels: Many[Label]
    findings: Many[Finding]
    coverage: Many[Coverage]
    is_behind: bool


@dataclass(frozen=True)
class _Known:
    labels: list[Label]
    check: LabelCheck
    revisions: Mapping[uuid.UUID, int]
    done_at: float
    spent: float

    def see(self, revisions: Mapping[uuid.UUID, int]) -> Flagged:
        """What of it still holds."""
        found = [one for one in self.check.findings if revisions.get(one.label.id) == one.label.revision]
        return Flagged(self.labels, found, self.check.coverage, revisions != self.revisions)


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
        self.turns = CapacityLimiter(2)

    def find(
        self,
        database: Database,
        sequence_id: uuid.UUID,
        content_key: str,
        hands: Many[str],
        track: Compared | None,
    ) -> Flagged:
        """What the checks of the labels found and looked at; `track` is the one they are compared with, if any."""
        with database.reading() as session:
            job_id = find_detections(session, sequence_id)
        key = (sequence_id, content_key, tuple(hands), track, job_id)
        with self._lock:  # one at a time: several people open the same page
            with database.reading() as session:
                revisions = find_revisions(session, sequence_id)
            known = self._known.get(key)
            spent = 0.0 if known is None else max(0.0, known.spent - SHARE * (time.monotonic() - known.done_at))
            if known is None or (known.revisions != revisions and spent < CREDIT_SECONDS):
                known = self._known[key] = self._check(database, key, spent)
                revisions = known.revisions
                while len(self._known) > KEPT:
                    self._known.popitem(last=False)
            self._known.move_to_end(key)
        return known.see(revisions)

    def _check(
        self,
        database: Database,
        about: tuple[uuid.UUID, str, Many[str], Compared | None, uuid.UUID | None],
        spent: float,
    ) -> _Known:
        from tracker import load_sequence

        sequence_id, _, hands, track, job_id = about
        began = time.monotonic()
        with database.reading() as session:
            rows, _ = list_annotations(session, sequence_id)
            session.expunge_all()
        recording = load_sequence(self._storage.folder("sequences", sequence_id))
        labels = self._read(recording, rows)
        setting = self._describe(recording, hands, track)
        if job_id is not None:
            setting = replace(setting, detected=_read_detections(self._storage.document(AREA, job_id)))
        check = check_labels(labels, setting)
        now = time.monotonic()
        return _Known(labels, check, {row.id: row.revision for row in rows}, now, spent + now - began)

    def _describe(self, recording: Sequence, hands: Many[str], track: Compared | None) -> Setting:
        cameras = {camera.id: camera for camera in recording.cameras}
        setting = Setting(tuple(hands), dict(cameras), any(camera.has_depth for camera in cameras.values()))
        if track is None:
            return setting
        missing = (
            f"{track.name} does not have this hand or frame, lost it, or the joints of the label came from a track"
        )
        tracked = _read_track(self._storage.folder("tracks", track.id))
        return replace(setting, tracked=tracked, track_missing=missing)

    def _read(self, recording: Sequence, rows: Many[AnnotationRow]) -> list[Any]:
        cameras = {camera.id for camera in recording.cameras}
        return self._reader.read(recording, [row for row in rows if row.camera in cameras])


def _read_track(folder: Path) -> dict[tuple[str, int, str], npt.NDArray[np.float64]]:
    """(21, 2) px of a track's hands by camera, frame and hand; hands that it lost are left out."""
    with np.load(folder / "track.npz", allow_pickle=False) as arrays:
        frames, status = arrays["frame"].tolist(), arrays["status"].tolist()
        of_hands = {
            str(hand): arrays["hand_status"][:, column].tolist()
            for column, hand in enumerate(arrays["hand_names"].tolist() if "hand_status" in arrays else [])
        }
        cameras = [str(name) for name in arrays["camera_ids"]]
        names = [str(name) for name in arrays["joint_names"]]
        joints = arrays["joints_2d"].astype(np.float64)
    found = {}
    for hand in ("right", "left"):
        columns = [place for place, name in enumerate(names) if name.startswith(f"{hand}/")]
        if len(columns) != 21:
            continue
        for row, frame in enumerate(frames):
            if "lost" not in (status[row], of_hands.get(hand, status)[row]):
                for index, camera in enumerate(cameras):
                    found[camera, frame, hand] = joints[row, index, columns]
    return found


def _read_detections(path: Path) -> dict[tuple[str, int, str], npt.NDArray[np.float64]]:
    """(21, 2) px of detected hands by camera, frame and hand; NaN where a joint is outside the image."""
    from tracker import load_recorded_hands

    return {
        (item.camera, item.frame, item.hand): np.where(item.points[:, 2:] > 0, item.points[:, :2], np.nan)
        for item in load_recorded_hands(path).hands.items
    }


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
    """Take that back; nothing happens when nobody said it."""
    row = get_annotation(session, place)
    session.execute(
        delete(DismissalRow).where(
            DismissalRow.annotation_id == row.id, DismissalRow.revision == revision, DismissalRow.kind == kind
        )
    )


async def get_flag_finder(connection: HTTPConnection) -> AsyncIterator[FlagFinder]:
    """The app's; who waits for it does so here, not in a thread."""
    state = connection.app.state
    if not hasattr(state, "flag_finder"):
        state.flag_finder = FlagFinder(state.storage)
    async with state.flag_finder.turns:
        yield state.flag_finder


FlagFinderDep = Annotated[FlagFinder, Depends(get_flag_finder, scope="function")]

"""Tracks against labels, each pair worked out once."""

from __future__ import annotations

import hashlib
import threading
import uuid
from collections import OrderedDict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from server.database import Database
from server.evaluations.labels import LabelsId, read_labels
from server.storage import Storage

if TYPE_CHECKING:
    from tracker.evaluation import Evaluation

MOST = 48
"""Verdicts that stay in memory; one of 1,500 frames and two hands takes about 3 MB."""


@dataclass(frozen=True, eq=False)
class Verdict:
    """A track judged by labels; neither changes ever.

    Attributes:
        evaluation: The errors of all joints, whatever they came from; `select` takes those that are to count.
        parameters: Of the run that made the track.
        labels: Where the labels come from.
        track_sha256: Of `track.npz`.
    """

    evaluation: Evaluation
    parameters: dict[str, Any]
    labels: dict[str, Any]
    track_sha256: str


class Judge:
    """Judges and remembers, the least recently asked for forgotten first. Who asks for the same at a time waits."""

    def __init__(self, storage: Storage) -> None:
        self._storage = storage
        self._verdicts: OrderedDict[tuple[uuid.UUID, str], Verdict] = OrderedDict()
        self._locks: dict[tuple[uuid.UUID, str], threading.Lock] = {}
        self._lock = threading.Lock()

    def find(self, database: Database, track_id: uuid.UUID, labels: LabelsId) -> Verdict:
        """The verdict, worked out now if need be, which may take seconds."""
        key = (track_id, labels.key)
        with self._lock:
            lock = self._locks.setdefault(key, threading.Lock())
        with lock:
            with self._lock:
                if key in self._verdicts:
                    self._verdicts.move_to_end(key)
                    return self._verdicts[key]
            try:
                verdict = self._judge(database, track_id, labels)
            finally:
                with self._lock:
                    self._locks.pop(key, None)
            with self._lock:
                self._verdicts[key] = verdict
                while len(self._verdicts) > MOST:
                    self._verdicts.popitem(last=False)
            return verdict

    def _judge(self, database: Database, track_id: uuid.UUID, which: LabelsId) -> Verdict:
        from tracker import load_track
        from tracker.evaluation import evaluate_track

        with database.reading() as session:
            labels = read_labels(session, self._storage, which)
        folder = self._storage.folder("tracks", track_id)
        track = load_track(folder)
        return Verdict(
            evaluation=evaluate_track(track, labels.annotations, ("all",)),
            parameters=track.setup.options.to_json(),
            labels=labels.facts,
            track_sha256=hashlib.sha256((folder / "track.npz").read_bytes()).hexdigest(),
        )

"""A recording that the hand detector has looked through."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from server.database import Database, utc_now
from server.jobs.detections import AREA
from server.jobs.service import create_job
from server.storage import Storage
from tests.server.conftest import MakeRecording
from tests.server.quality.desk import SIZE, Desk
from tracker import Annotation, Annotations
from tracker.detection import RecordedHands

Keep = Callable[[uuid.UUID, RecordedHands], None]


@pytest.fixture
def keep_detections(studio) -> Keep:
    """Keeps what a job found in a whole recording."""

    def keep(sequence_id: uuid.UUID, found: RecordedHands) -> None:
        storage = studio.app.state.storage
        with studio.database.writing() as session:
            job = create_job(session, "detect", sequence_id, {})
            job.state, job.ended_at = "succeeded", utc_now()
            storage.document(AREA, job.id)
            found.save(storage.root / AREA / f"{job.id}.json")

    return keep


def see(marks: Mapping[tuple[str, int, str], np.ndarray], frames: range) -> RecordedHands:
    """As if the detector saw hands there: (21, 2) px by camera, frame and hand."""
    items = [
        Annotation(frame, camera, hand, np.column_stack([pixels, np.full(21, 2.0)]))
        for (camera, frame, hand), pixels in sorted(marks.items(), key=lambda one: (one[0][1], one[0][0], one[0][2]))
    ]
    cameras = tuple(sorted({camera for camera, _, _ in marks}))
    return RecordedHands(cameras, frames, Annotations(tuple(items)), {item.key: 0.9 for item in items})


@pytest.fixture
def desk(database: Database, make_recording: MakeRecording, tmp_path: Path) -> Desk:
    """A recording of four frames in one colour camera, without labels."""
    folder = make_recording("waving", 4, "jpg", depth=False, size=SIZE)
    return Desk.open(database, Storage(tmp_path / "studio"), folder)

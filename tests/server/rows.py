"""Rows without files, for tests of what the database alone is asked."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

from server.access.models import Account, Role
from server.annotations.models import AnnotationRow
from server.annotations.sources import count_decided
from server.database import Base, Database
from server.sequences.models import SequenceRow
from server.tracks.models import TrackRow


def keep(database: Database, *rows: Base) -> None:
    """Store rows, each after those before it."""
    with database.writing() as session:
        for row in rows:
            session.add(row)
            session.flush()


def make_person(name: str, role: Role = "annotator") -> Account:
    return Account(id=uuid.uuid4(), name=name, role=role)


def make_recording(name: str = "waving", cameras: Sequence[str] = ("cam0",), **columns: Any) -> SequenceRow:
    """12 frames of 32x24 px, a right hand."""
    facts = {"id": uuid.uuid4(), "fps": 30.0, "frame_count": 12, "hands": ["right"], "objects": [], "content_key": "x"}
    views = [{"id": camera, "width": 32, "height": 24} for camera in cameras]
    return SequenceRow(**(facts | {"name": name, "cameras": views} | columns))


def make_annotation(
    recording: SequenceRow, frame: int, points: list[Any] | None, hand: str = "right", **columns: Any
) -> AnnotationRow:
    """A hand as its first revision."""
    place = {"sequence_id": recording.id, "camera": "cam0", "frame": frame, "hand": hand}
    state = {"id": uuid.uuid4(), "points": points, "decided": count_decided(points), "revision": 1}
    return AnnotationRow(**(place | state | columns))


def make_track(recording: SequenceRow, name: str = "Track 1", **columns: Any) -> TrackRow:
    """A track without files."""
    facts = {"id": uuid.uuid4(), "frame_first": 0, "frame_count": 12, "hands": ["right"], "summary": {}}
    return TrackRow(**(facts | {"sequence_id": recording.id, "name": name} | columns))

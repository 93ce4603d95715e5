"""The track that suggestions come from, and fits that need enough joints."""

from __future__ import annotations

import uuid
from typing import Any

import pytest
from sqlalchemy.orm import Session

from server.access.places import Place
from server.compute import ComputeContext
from server.database import Database, utc_now
from server.errors import InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from server.storage import Storage
from server.suggestions.service import ChosenTrack, Recorded, choose_track, suggest_by_fit
from server.tracks.models import TrackRow
from tracker import MIN_FIT_JOINTS


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


def add_recording(session: Session) -> uuid.UUID:
    columns: dict[str, Any] = {"cameras": [], "hands": ["right"], "objects": [], "report": None}
    row = SequenceRow(name="wave", fps=30.0, frame_count=40, content_key="x", **columns)
    session.add(row)
    session.flush()
    return row.id


def add_track(session: Session, recording: uuid.UUID, name: str, lost: int = 0) -> TrackRow:
    columns: dict[str, Any] = {"frame_first": 0, "frame_count": 40, "hands": ["right"], "summary": {"lost": lost}}
    row = TrackRow(sequence_id=recording, job_id=None, name=name, **columns)
    session.add(row)
    session.flush()
    return row


def test_the_best_track_suggests_unless_another_is_asked_for(database: Database) -> None:
    with database.writing() as session:
        recording = add_recording(session)
        worse, best = add_track(session, recording, "Track 1", lost=9), add_track(session, recording, "Track 2")
        assert choose_track(session, recording, None) == ChosenTrack(best.id, "Track 2")
        assert choose_track(session, recording, worse.id) == ChosenTrack(worse.id, "Track 1")
        best.deleted_at = utc_now()
        session.flush()
        assert choose_track(session, recording, None) == ChosenTrack(worse.id, "Track 1")
        with pytest.raises(NotFoundError, match="This track was deleted"):
            choose_track(session, recording, best.id)


def test_a_recording_without_tracks_has_none_to_choose(database: Database) -> None:
    with database.writing() as session:
        assert choose_track(session, add_recording(session), None) is None


def test_a_track_of_another_recording_does_not_suggest(database: Database) -> None:
    with database.writing() as session:
        recording, other = add_recording(session), add_recording(session)
        track = add_track(session, other, "Track 1")
        with pytest.raises(NotFoundError, match=f"The track {track.id} is of another recording"):
            choose_track(session, recording, track.id)
        with pytest.raises(NotFoundError, match="There is no track"):
            choose_track(session, recording, uuid.uuid4())


@pytest.mark.parametrize(
    ("placed", "told"), [(0, "0 joints are"), (1, "1 joint is"), (MIN_FIT_JOINTS - 1, "joints are")]
)
def test_too_few_joints_are_refused_with_how_many_are_needed_before_any_file_is_read(
    database: Database, tmp_path, placed: int, told: str
) -> None:
    context, id_ = ComputeContext(database, Storage(tmp_path / "studio")), uuid.uuid4()
    points = [[10.0, 10.0, 2 if joint < placed else 0] for joint in range(21)]
    with pytest.raises(InvalidError, match=f"{told} placed; a model fit needs {MIN_FIT_JOINTS} or more. Place some"):
        suggest_by_fit(context, Recorded(id_, "x"), None, Place(id_, "cam0", 0, "right"), points)

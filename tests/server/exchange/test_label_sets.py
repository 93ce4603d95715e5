"""Labels on their way out: those of now or of a snapshot, of the right recording, without what is hidden."""

from __future__ import annotations

import uuid
from pathlib import Path

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.annotations.snapshots import create_snapshot
from server.database import Database, utc_now
from server.errors import ForbiddenError, InvalidError, NotFoundError
from server.exchange.label_sets import check_sees_all, check_track, keep_visible, open_label_set, read_labels
from server.storage import Storage
from tests.server.access.test_policy import Bench
from tests.server.conftest import MakeRecording
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_track
from tests.server.rows import make_recording as make_row
from tracker import Annotation, Annotations


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def make_labels(*frames: int) -> Annotations:
    return Annotations(tuple(Annotation(frame, "cam0", "right", np.array(make_points())) for frame in frames))


def list_frames(annotations: Annotations) -> list[int]:
    return [item.frame for item in annotations.items]


def test_a_recording_without_labels_is_a_set_with_its_images(
    database: Database, tmp_path: Path, make_recording: MakeRecording
) -> None:
    storage, row = Storage(tmp_path / "files"), make_row()
    make_recording("waving").rename(storage.folder("sequences", row.id))
    made = open_label_set(storage, row)
    assert (made.key, made.sequence.frame_count, made.annotations.items, made.track_joints) == (str(row.id), 3, (), {})
    assert open_label_set(storage, row, make_labels(1)).annotations.items[0].frame == 1


def test_labels_are_those_of_now_or_of_a_snapshot_of_the_same_recording(database: Database, tmp_path: Path) -> None:
    storage, recording, other = Storage(tmp_path / "files"), make_row(), make_row("other")
    keep(database, recording, other, make_annotation(recording, 1, make_points()))
    with database.writing() as session:
        snapshot, _ = create_snapshot(session, storage, recording, "one", LOCAL_ACCOUNT_ID)
    keep(database, make_annotation(recording, 2, make_points()))
    with database.reading() as session:
        assert list_frames(read_labels(session, storage, recording.id)) == [1, 2]
        assert list_frames(read_labels(session, storage, recording.id, snapshot)) == [1]
        assert list_frames(read_labels(session, storage, other.id)) == []
        with pytest.raises(InvalidError, match="The snapshot 'one' is of another recording"):
            read_labels(session, storage, other.id, snapshot)


def test_a_track_is_taken_for_its_own_recording_alone(database: Database) -> None:
    recording, other = make_row(), make_row("other")
    track, gone = make_track(recording), make_track(recording, deleted_at=utc_now())
    keep(database, recording, other, track, gone)
    unknown = uuid.uuid4()
    with database.reading() as session:
        check_track(session, recording.id, track.id)
        with pytest.raises(InvalidError, match=f"The track {track.id} is of another recording"):
            check_track(session, other.id, track.id)
        with pytest.raises(NotFoundError, match="This track was deleted"):
            check_track(session, recording.id, gone.id)
        with pytest.raises(NotFoundError, match=f"There is no track {unknown}"):
            check_track(session, recording.id, unknown)


def test_who_marks_blindly_sees_the_labels_of_other_frames_until_the_work_is_accepted(database: Database) -> None:
    bench = Bench(database)
    ann, bob, done = bench.person("ann"), bench.person("bob", "lead"), bench.person("cleo")
    bench.give_blindly(ann, [2, 5])
    bench.give_blindly(done, [2, 5], "accepted")
    labels = make_labels(1, 2, 4, 5)
    with database.reading() as session:
        assert list_frames(keep_visible(session, ann, bench.recording, labels)) == [1, 4]
        with pytest.raises(ForbiddenError, match="You are marking frames of this recording blind"):
            check_sees_all(session, ann, bench.recording)
        for person in (bob, done):
            assert keep_visible(session, person, bench.recording, labels) is labels
            check_sees_all(session, person, bench.recording)

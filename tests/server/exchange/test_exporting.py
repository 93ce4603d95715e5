"""Labels as a file: one or a zip as the format is, of the recordings in the order asked for, with what was lost."""

from __future__ import annotations

import io
import json
import uuid
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest

from server.access.models import LOCAL_ACCOUNT_ID, Account
from server.annotations.snapshots import create_snapshot
from server.compute import ComputeContext
from server.database import Database
from server.errors import InvalidError, NotFoundError
from server.exchange.exporting import ExportChoice, LabelFile, export
from server.sequences.models import SequenceRow
from server.storage import Storage
from tests.server.access.test_policy import Bench
from tests.server.conftest import MakeRecording
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_track
from tests.server.rows import make_recording as make_row

LOCAL = Account(id=LOCAL_ACCOUNT_ID, name="local", role="admin")


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@dataclass
class Desk:
    """Two recordings of three frames: the first with a label in each of its frames 0 and 2, the second in frame 1."""

    context: ComputeContext
    first: SequenceRow
    second: SequenceRow

    def export(self, format_: str, *rows: SequenceRow, account: Account = LOCAL, **more: object) -> LabelFile:
        choice = ExportChoice(format_, ["all"], **more)  # type: ignore[arg-type]
        return export(self.context, account, [row.id for row in rows], choice)


@pytest.fixture
def desk(database: Database, tmp_path: Path, make_recording: MakeRecording) -> Desk:
    storage, rows = Storage(tmp_path / "files"), [make_row("one", frame_count=3), make_row("two", frame_count=3)]
    keep(database, *rows)
    for row in rows:
        make_recording(row.name).rename(storage.folder("sequences", row.id))
    occluded = make_points(v=1)
    keep(database, *(make_annotation(rows[0], frame, make_points()) for frame in (0, 2)))
    keep(database, make_annotation(rows[1], 1, occluded, "left"))
    return Desk(ComputeContext(database, storage), *rows)


def frames_of(made: LabelFile) -> list[int]:
    return [item["frame"] for item in json.loads(made.data)["items"]]


def test_one_file_is_given_as_it_is_and_several_in_a_zip(desk: Desk) -> None:
    made = desk.export("annotations", desk.first)
    assert frames_of(made) == [0, 2] and (made.items, made.joints, made.notes) == (2, 42, ())
    packed = desk.export("deeplabcut", desk.second)
    with zipfile.ZipFile(io.BytesIO(packed.data)) as archive:
        assert archive.testzip() is None and any(name.endswith(".csv") for name in archive.namelist())
    assert packed.notes == ("21 occluded joints: DeepLabCut does not say what is occluded.",)


def test_several_recordings_come_in_the_order_asked_for(desk: Desk) -> None:
    for rows in ((desk.first, desk.second), (desk.second, desk.first)):
        made = desk.export("coco_keypoints", *rows)
        keys = list(dict.fromkeys(image["sequence"] for image in json.loads(made.data)["images"]))
        assert keys == [str(row.id) for row in rows] and made.items == 3


def test_a_snapshot_is_exported_as_it_was_and_of_its_own_recording_alone(desk: Desk) -> None:
    with desk.context.database.writing() as session:
        snapshot, _ = create_snapshot(session, desk.context.storage, desk.first, "was", LOCAL_ACCOUNT_ID)
    was = desk.export("annotations", desk.first).data
    keep(desk.context.database, make_annotation(desk.first, 1, make_points()))
    assert frames_of(desk.export("annotations", desk.first)) == [0, 1, 2]
    assert desk.export("annotations", desk.first, snapshot_id=snapshot.id).data == was
    with pytest.raises(InvalidError, match="The snapshot 'was' is of another recording"):
        desk.export("annotations", desk.second, snapshot_id=snapshot.id)
    with pytest.raises(NotFoundError, match="There is no snapshot"):
        desk.export("annotations", desk.first, snapshot_id=uuid.uuid4())


def test_a_track_of_another_recording_and_a_recording_that_is_none_are_refused(desk: Desk) -> None:
    track = make_track(desk.second)
    keep(desk.context.database, track)
    with pytest.raises(InvalidError, match="is of another recording"):
        desk.export("interhand", desk.first, track_id=track.id)
    with pytest.raises(NotFoundError, match="does not exist"):
        desk.export("annotations", make_row())


def test_who_marks_blindly_gets_no_labels_of_the_same_places(desk: Desk) -> None:
    bench = Bench(desk.context.database)
    bench.recording = desk.first.id
    ann = bench.person("ann")
    bench.give_blindly(ann, [2])
    made = desk.export("annotations", desk.first, account=ann)
    assert frames_of(made) == [0] and made.items == 1
    assert frames_of(desk.export("annotations", desk.first)) == [0, 2]

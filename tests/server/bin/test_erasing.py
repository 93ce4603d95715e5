"""What is deleted for good takes along what means nothing without it, and nothing that others need."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID, Account, AuditRow
from server.access.project_models import ProjectRow
from server.annotations.models import AnnotationRevisionRow, AnnotationRow
from server.annotations.snapshot_models import SnapshotRow
from server.bin.erasing import DOCUMENTS, FOLDERS, GO_TOO, NEEDS, WORDS, describe, erase, remove_files
from server.bin.kinds import BIN_KINDS
from server.bin.schemas import BinErasure
from server.database import Base, Database, utc_now
from server.errors import ConflictError, NotFoundError
from server.hand_models.models import HandModelRow
from server.jobs.models import JobRow
from server.sequences.models import SequenceRow
from server.storage import Storage
from server.tracks.models import TrackRow
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_recording, make_track


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@dataclass
class Desk:
    """Where things are deleted for good."""

    database: Database
    storage: Storage

    def describe(self, kind: str, id_: uuid.UUID) -> BinErasure:
        with self.database.reading() as session:
            return describe(session, self.storage, kind, id_)

    def erase(self, kind: str, id_: uuid.UUID) -> list[tuple[str, uuid.UUID]]:
        with self.database.writing() as session:
            return erase(session, self.storage, session.get_one(Account, LOCAL_ACCOUNT_ID), kind, id_)

    def ids(self, row: type[Base]) -> set[uuid.UUID]:
        with self.database.reading() as session:
            return set(session.scalars(select(row.id)))


@pytest.fixture
def desk(database: Database, tmp_path: Path) -> Desk:
    return Desk(database, Storage(tmp_path / "files"))


def make_job(state: str = "succeeded", **columns: Any) -> JobRow:
    return JobRow(id=uuid.uuid4(), kind="track", state=state, params={}, **columns)


def make_model(name: str, **columns: Any) -> HandModelRow:
    facts = {"id": uuid.uuid4(), "kind": "trained", "side": "right", "digest": "0" * 64, "facts": {}}
    return HandModelRow(name=name, **(facts | columns))


def test_the_lists_name_tables_columns_and_folders_that_there_are() -> None:
    tables = Base.metadata.tables
    assert {*WORDS, *FOLDERS, *DOCUMENTS} <= tables.keys()
    for table, column in (*GO_TOO, *NEEDS):
        assert tables[table].c[column].foreign_keys, (table, column)
    for kind in BIN_KINDS:
        assert FOLDERS.get(kind.row.__tablename__) == kind.area, "a kind with files loses them, one without stays"


def test_a_recording_goes_with_all_that_hangs_on_it_and_another_keeps_its_own(desk: Desk) -> None:
    gone, other = make_recording("gone", deleted_at=utc_now()), make_recording("other")
    labels = [make_annotation(gone, frame, make_points()) for frame in range(3)]
    past = [
        AnnotationRevisionRow(annotation_id=row.id, revision=1, operation_id=uuid.uuid4(), act="put") for row in labels
    ]
    track, job = make_track(gone), make_job(sequence_id=gone.id)
    snapshot = SnapshotRow(id=uuid.uuid4(), sequence_id=gone.id, version=1, name="a", content_hash="0" * 64)
    snapshot.item_count = snapshot.joint_count = 0
    others = [make_annotation(other, 0, make_points()), make_track(other), make_job(sequence_id=other.id)]
    keep(desk.database, gone, other, *labels, *past, track, job, snapshot, *others)
    desk.storage.folder("sequences", gone.id).mkdir()
    (desk.storage.folder("sequences", gone.id) / "sequence.json").write_bytes(b"x" * 40)
    desk.storage.add_document("snapshots", snapshot.id, b"labels")

    told = desk.describe("recording", gone.id)
    assert (told.word, told.name, told.byte_count, told.obstacle) == ("recording", "gone", 40, None)
    assert {one.word: one.count for one in told.going} == {"label": 3, "track": 1, "label snapshot": 1, "job": 1}
    left = desk.erase("recording", gone.id)
    assert set(left) == {
        ("sequences", gone.id),
        ("tracks", track.id),
        ("jobs", job.id),
        ("snapshots", snapshot.id),
    }
    remove_files(desk.storage, left)
    assert not [path for path in desk.storage.root.rglob("*") if path.is_file()]
    assert desk.ids(SequenceRow) == {other.id} and desk.ids(AnnotationRevisionRow) == set()
    for row in others:
        assert desk.ids(type(row)) == {row.id}
    with desk.database.reading() as session:
        [line] = session.scalars(select(AuditRow))
    assert (line.act, line.subject_id, line.account_id) == ("recording.erase", gone.id, LOCAL_ACCOUNT_ID)
    assert line.detail == {"name": "gone", "label": 3, "track": 1, "label snapshot": 1, "job": 1}


def test_a_track_goes_and_the_job_that_made_it_stays_without_it(desk: Desk) -> None:
    recording = make_recording()
    track = make_track(recording, deleted_at=utc_now())
    job = make_job(sequence_id=recording.id, track_id=track.id)
    keep(desk.database, recording, track, job)
    assert desk.describe("track", track.id).going == []
    assert desk.erase("track", track.id) == [("tracks", track.id)]
    with desk.database.reading() as session:
        assert session.get_one(JobRow, job.id).track_id is None
    assert desk.ids(TrackRow) == set() and desk.ids(SequenceRow) == {recording.id}


@pytest.mark.parametrize("state", ["queued", "running"])
def test_what_a_job_uses_waits_for_its_end(desk: Desk, state: str) -> None:
    recording = make_recording(deleted_at=utc_now())
    job = make_job(state, sequence_id=recording.id)
    label = make_annotation(recording, 0, make_points())
    keep(desk.database, recording, label, job)
    said = "a job that uses it is queued or running: cancel it, or wait for it"
    assert desk.describe("recording", recording.id).obstacle == said
    with pytest.raises(ConflictError, match=f"The recording “waving” cannot be deleted for good: {said}"):
        desk.erase("recording", recording.id)
    assert desk.ids(AnnotationRow) == {label.id}
    with desk.database.writing() as session:
        session.get_one(JobRow, job.id).state = "cancelled"
    desk.erase("recording", recording.id)
    assert desk.ids(JobRow) == desk.ids(SequenceRow) == set()


def test_a_model_that_another_was_trained_from_stays_until_that_one_is_gone(desk: Desk) -> None:
    first = make_model("first", deleted_at=utc_now())
    second = make_model("second", parent_id=first.id, deleted_at=utc_now())
    keep(desk.database, first, second)
    with pytest.raises(ConflictError, match=r"“first” .*: a newer hand model was trained from it"):
        desk.erase("hand_model", first.id)
    assert desk.erase("hand_model", second.id) == [("models", second.id)]
    assert desk.erase("hand_model", first.id) == [("models", first.id)]


def test_a_project_has_no_files_and_stays(desk: Desk) -> None:
    project = ProjectRow(id=uuid.uuid4(), name="Hands", archived_at=utc_now())
    keep(desk.database, project)
    with pytest.raises(ConflictError, match=r"a project holds no files, .* so it stays in the bin"):
        desk.erase("project", project.id)
    assert desk.ids(ProjectRow) == {project.id}


def test_only_what_is_in_the_bin_goes(desk: Desk) -> None:
    recording, unknown = make_recording(), uuid.uuid4()
    keep(desk.database, recording)
    for id_ in (recording.id, unknown):
        for act in (desk.describe, desk.erase):
            with pytest.raises(NotFoundError, match=f"The bin holds no recording {id_}. Somebody may have restored it"):
                act("recording", id_)
    assert desk.ids(SequenceRow) == {recording.id}


def test_files_that_are_gone_already_do_not_hinder(desk: Desk) -> None:
    remove_files(desk.storage, [("sequences", uuid.uuid4()), ("snapshots", uuid.uuid4())])

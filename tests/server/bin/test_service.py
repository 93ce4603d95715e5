"""The bin lists what was deleted with who did it last, and gives nothing back before what it is part of."""

from __future__ import annotations

import uuid
from datetime import timedelta
from pathlib import Path

import pytest

from server.access.models import LOCAL_ACCOUNT_ID, Account, AuditRow
from server.access.project_models import ProjectRow
from server.bin.service import list_bin, measure_files, restore
from server.database import Database, utc_now
from server.errors import ConflictError, NotFoundError
from server.sequences.models import SequenceRow
from server.storage import Storage
from tests.server.rows import keep, make_person, make_recording, make_track

NOW = utc_now()


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def storage(tmp_path: Path) -> Storage:
    return Storage(tmp_path / "files")


def ago(minutes: int) -> object:
    return NOW - timedelta(minutes=minutes)


def test_things_of_all_kinds_come_in_pages_the_last_deleted_first(database: Database, storage: Storage) -> None:
    first, second = make_recording("first", deleted_at=ago(9)), make_recording("second", deleted_at=ago(5))
    there = make_recording("there")
    track = make_track(there, "Track 3", deleted_at=ago(7))
    project = ProjectRow(id=uuid.uuid4(), name="Hands", archived_at=ago(1))
    keep(database, first, second, there, track, make_track(there), project)
    found, cursor = [], None
    with database.reading() as session:
        for _ in range(2):
            items, cursor = list_bin(session, storage, None, cursor, 2)
            found += [(item.kind, item.word, item.name, item.deleted_at) for item in items]
        only, _ = list_bin(session, storage, "recording", None, 100)
    assert found == [
        ("project", "project", "Hands", ago(1)),
        ("recording", "recording", "second", ago(5)),
        ("track", "track", "Track 3", ago(7)),
        ("recording", "recording", "first", ago(9)),
    ]
    assert cursor is None and [item.name for item in only] == ["second", "first"]


def test_who_deleted_it_last_is_named_whatever_was_done_to_it_besides(database: Database, storage: Storage) -> None:
    ann, bob = make_person("ann"), make_person("bob")
    twice, alone, project = (
        make_recording("twice", deleted_at=ago(1)),
        make_recording("alone", deleted_at=ago(2)),
        ProjectRow(id=uuid.uuid4(), name="Hands", archived_at=ago(3)),
    )
    acts = [
        (9, ann, "recording.delete", twice),
        (8, ann, "recording.restore", twice),
        (7, bob, "recording.delete", twice),
        (6, ann, "recording.rename", twice),
        (5, ann, "project.archive", project),
    ]
    lines = [
        AuditRow(time=ago(when), account_id=who.id, act=act, subject="x", subject_id=what.id)
        for when, who, act, what in reversed(acts)
    ]
    script = AuditRow(time=ago(5), account_id=None, act="recording.delete", subject="x", subject_id=alone.id)
    keep(database, ann, bob, twice, alone, project, *lines, script)
    with database.reading() as session:
        items, _ = list_bin(session, storage, None, None, 100)
    assert {item.name: item.deleted_by_name for item in items} == {"twice": "bob", "alone": None, "Hands": "ann"}


def test_the_size_is_that_of_all_files_and_nothing_of_what_has_none(database: Database, storage: Storage) -> None:
    recording = make_recording(deleted_at=ago(1))
    project = ProjectRow(id=uuid.uuid4(), name="Hands", archived_at=ago(3))
    keep(database, recording, project)
    deep = storage.folder("sequences", recording.id) / "color" / "left"
    deep.mkdir(parents=True)
    (deep / "0.png").write_bytes(b"x" * 30)
    (deep.parent / "1.png").write_bytes(b"x" * 12)
    with database.reading() as session:
        items, _ = list_bin(session, storage, None, None, 100)
    assert [item.byte_count for item in items] == [42, None]
    assert measure_files(storage, "sequences", uuid.uuid4()) == 0


def test_a_track_waits_for_its_recording(database: Database) -> None:
    recording = make_recording(deleted_at=ago(1))
    track = make_track(recording, deleted_at=ago(2))
    keep(database, recording, track)
    with database.writing() as session:
        local = session.get_one(Account, LOCAL_ACCOUNT_ID)
        with pytest.raises(
            ConflictError, match=r"The recording “waving” that it belongs to is in the bin too. Restore"
        ):
            restore(session, local, "track", track.id)
        restore(session, local, "recording", recording.id)
        restore(session, local, "track", track.id)
        with pytest.raises(NotFoundError, match=f"The bin holds no track {track.id}"):
            restore(session, local, "track", track.id)
    with database.reading() as session:
        assert session.get_one(SequenceRow, recording.id).deleted_at is None


def test_a_kind_that_there_is_not_is_refused_with_those_there_are(database: Database, storage: Storage) -> None:
    with database.reading() as session, pytest.raises(NotFoundError, match="The bin has no 'moon'; it has recording, "):
        list_bin(session, storage, "moon", None, 10)

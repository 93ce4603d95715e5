"""Labels that judge have a name that changes with any change of theirs, and say where they come from."""

from __future__ import annotations

import hashlib
import json
import uuid
from pathlib import Path

import pytest
from sqlalchemy import update

from server.access.models import LOCAL_ACCOUNT_ID
from server.annotations.models import AnnotationRow
from server.annotations.service import export_annotations
from server.annotations.snapshots import create_snapshot
from server.database import Database
from server.errors import InvalidError, NotFoundError
from server.evaluations.labels import find_current_labels, find_snapshots, read_labels
from server.storage import Storage
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_recording


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def test_any_change_of_a_label_is_another_name_and_blind_labels_are_none(database: Database) -> None:
    recording, other = make_recording(), make_recording("other")
    keep(database, recording, other, make_annotation(other, 0, make_points(), revision=9))

    def find_key() -> str:
        with database.reading() as session:
            found = find_current_labels(session, recording.id)
        assert found.key == f"now-{found.revision}" and found.snapshot is None
        return found.key

    keys = [find_key()]
    keep(database, make_annotation(recording, 0, make_points()), make_annotation(recording, 1, make_points()))
    keys.append(find_key())
    with database.writing() as session:  # a deletion is a change too
        session.execute(update(AnnotationRow).where(AnnotationRow.frame == 1).values(points=None, revision=2))
    keys.append(find_key())
    keep(database, make_annotation(recording, 2, make_points(), replica="blind", revision=5))
    assert keys == ["now-0", "now-2", "now-3"] and find_key() == "now-3"


def test_labels_of_now_say_their_revision_and_the_hash_of_their_file(database: Database, tmp_path: Path) -> None:
    recording = make_recording()
    keep(database, recording, make_annotation(recording, 4, make_points(), revision=3))
    with database.reading() as session:
        found = read_labels(session, Storage(tmp_path / "files"), find_current_labels(session, recording.id))
        written = json.dumps(export_annotations(session, recording.id), separators=(",", ":")) + "\n"
    sha256 = hashlib.sha256(written.encode()).hexdigest()
    assert found.facts == {"kind": "now", "revision": 3, "sha256": sha256, "items": 1}
    [item] = found.annotations.items
    assert item.key == (4, "cam0", "right") and item.points.tolist() == make_points()


def test_a_snapshot_judges_as_it_was_and_not_when_it_is_damaged(database: Database, tmp_path: Path) -> None:
    storage, recording = Storage(tmp_path / "files"), make_recording()
    keep(database, recording, make_annotation(recording, 4, make_points()))
    with database.writing() as session:
        row, _ = create_snapshot(session, storage, recording, "Good", LOCAL_ACCOUNT_ID)
    keep(database, make_annotation(recording, 5, make_points()))
    with database.reading() as session:
        [(sequence_id, which)] = find_snapshots(session, [row.id, row.id]).items()
        assert (sequence_id, which.key, which.revision) == (recording.id, f"snapshot-{row.id}", None)
        found = read_labels(session, storage, which)
        assert [item.frame for item in found.annotations.items] == [4]
        assert found.facts == {
            "kind": "snapshot",
            "snapshot_id": str(row.id),
            "version": 1,
            "name": "Good",
            "sha256": row.content_hash,
            "items": 1,
        }
        path = storage.document("snapshots", row.id)
        data = path.read_bytes()
        for harm in (lambda: path.write_bytes(data + b" "), path.unlink):
            harm()
            with pytest.raises(
                NotFoundError, match=r"'Good' is missing or damaged. Judge by another one, or by today's"
            ):
                read_labels(session, storage, which)


def test_a_snapshot_that_there_is_not_is_named(database: Database) -> None:
    unknown = uuid.uuid4()
    with database.reading() as session:
        assert find_snapshots(session, []) == {}
        with pytest.raises(NotFoundError, match=f"There is no snapshot {unknown}. Choose one of the recording's"):
            find_snapshots(session, [unknown])


def test_a_recording_is_judged_by_one_snapshot_and_not_by_whichever_comes_last(
    database: Database, tmp_path: Path
) -> None:
    storage, recording = Storage(tmp_path / "files"), make_recording()
    keep(database, recording)
    with database.writing() as session:
        first, _ = create_snapshot(session, storage, recording, "first", LOCAL_ACCOUNT_ID)
        session.add(make_annotation(recording, 0, make_points()))
        session.flush()
        second, _ = create_snapshot(session, storage, recording, "second", LOCAL_ACCOUNT_ID)
    with database.reading() as session:
        for ids in ([first.id, second.id], [second.id, first.id]):
            with pytest.raises(
                InvalidError, match=r"'first' and 'second' are of one recording.* Leave the other one out"
            ):
                find_snapshots(session, ids)
        assert find_snapshots(session, [second.id])[recording.id].key == f"snapshot-{second.id}"

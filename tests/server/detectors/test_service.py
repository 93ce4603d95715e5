"""Fingertip detectors are stored to the byte, and given out only while they are what they were."""

from __future__ import annotations

import uuid
from pathlib import Path

import pytest
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID, AuditRow
from server.database import Database
from server.detectors.models import DetectorRow
from server.detectors.service import (
    AREA,
    FILE,
    DamagedDetectorError,
    add_detector,
    delete_detector,
    find_file,
    get_detector,
    list_detectors,
    read_upload,
)
from server.errors import InvalidError, NotFoundError
from server.storage import Storage
from tracker.detection import load_forest
from tracker.detection.default_detector import DATA as DETECTOR


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def storage(tmp_path: Path) -> Storage:
    return Storage(tmp_path / "files")


def add(database: Database, storage: Storage, name: str = "Tips") -> DetectorRow:
    with database.writing() as session:
        return add_detector(session, storage, DETECTOR, read_upload(DETECTOR), name, LOCAL_ACCOUNT_ID)


def test_a_detector_is_kept_to_the_byte_with_what_it_is(database: Database, storage: Storage) -> None:
    row = add(database, storage)
    assert find_file(storage, row).read_bytes() == DETECTOR.read_bytes()
    forest = load_forest(DETECTOR)
    assert (row.looks_at, row.trees, row.byte_count) == (forest.kind, forest.num_trees, DETECTOR.stat().st_size)
    with database.reading() as session:
        [line] = session.scalars(select(AuditRow).where(AuditRow.subject_id == row.id))
    assert (line.act, line.detail) == ("detector.upload", {"sha256": row.digest})


@pytest.mark.parametrize("harm", ["change", "remove"])
def test_a_file_that_was_harmed_is_not_given_out_and_the_backup_named(
    database: Database, storage: Storage, harm: str
) -> None:
    row = add(database, storage)
    path = storage.folder(AREA, row.id) / FILE
    path.write_bytes(path.read_bytes()[:-1]) if harm == "change" else path.unlink()
    with pytest.raises(DamagedDetectorError, match=f"'Tips' is missing or was changed.* {AREA}/{row.id}/{FILE} from a"):
        find_file(storage, row)


def test_detectors_are_listed_the_newest_first_without_deleted_ones(database: Database, storage: Storage) -> None:
    first, second, third = (add(database, storage, name) for name in ("first", "second", "third"))
    with database.writing() as session:
        delete_detector(session, get_detector(session, second.id), LOCAL_ACCOUNT_ID)
        assert [row.name for row in list_detectors(session, None, 100)[0]] == ["third", "first"]
        page, cursor = list_detectors(session, None, 1)
        assert [row.id for row in page] == [third.id]
        assert [row.id for row in list_detectors(session, cursor, 1)[0]] == [first.id]
        assert get_detector(session, second.id, deleted_too=True).name == "second"
        with pytest.raises(NotFoundError, match="This fingertip detector was deleted"):
            get_detector(session, second.id)
        unknown = uuid.uuid4()
        with pytest.raises(NotFoundError, match=f"There is no fingertip detector {unknown}"):
            get_detector(session, unknown, deleted_too=True)


@pytest.mark.parametrize(("name", "data"), [("tips.npz", b""), ("tips.npz", b"PK no archive"), ("tips.txt", b"x")])
def test_a_file_that_is_none_is_named_without_the_folder_of_the_studio(tmp_path: Path, name: str, data: bytes) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(InvalidError) as refused:
        read_upload(path)
    assert name in refused.value.detail and str(tmp_path) not in refused.value.detail

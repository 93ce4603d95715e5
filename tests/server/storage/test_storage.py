"""Folders below the data folder."""

from __future__ import annotations

import uuid
from pathlib import Path

import pytest

from server.storage import Storage


@pytest.fixture
def storage(tmp_path: Path) -> Storage:
    return Storage(tmp_path / "new" / "data")


def test_every_thing_has_a_folder_of_its_own(storage: Storage) -> None:
    ids = [uuid.uuid4() for _ in range(3)]
    for id_ in ids:
        storage.folder("tracks", id_).mkdir()
    assert sorted(storage.list_ids("tracks")) == sorted(ids)
    assert storage.list_ids("sequences") == []


def test_a_name_from_outside_is_no_area(storage: Storage) -> None:
    for area in ("..", "a/b", "", ".hidden"):
        with pytest.raises(AssertionError):
            storage.folder(area, uuid.uuid4())


def test_what_is_removed_is_gone_at_once_and_for_good(storage: Storage) -> None:
    id_ = uuid.uuid4()
    folder = storage.folder("tracks", id_)
    (folder / "deep").mkdir(parents=True)
    (folder / "deep" / "file").write_text("x")
    storage.remove("tracks", id_)
    storage.remove("tracks", id_)
    assert list((storage.root / "tracks").iterdir()) == []


def test_a_removal_that_was_interrupted_is_finished(storage: Storage) -> None:
    half = storage.root / "tracks" / ".removed-1234"
    half.mkdir(parents=True)
    (half / "file").write_text("x")
    assert storage.list_ids("tracks") == []
    storage.sweep("tracks")
    assert not half.exists()

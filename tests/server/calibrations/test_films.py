"""Films are kept as they were sent, archives unpacked, and no more than is allowed comes out of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from server.calibrations.films import AREA, find_films, keep_films
from server.errors import InvalidError
from server.storage import Storage
from server.storage.upload import Upload, UploadLimits
from tests.server.calibrations.test_routes import pack
from tracker.errors import ImportRefusedError


def keep(tmp_path: Path, files: dict[str, bytes], most_files: int = 100, most_bytes: int = 10_000) -> dict[str, bytes]:
    """Send files as one upload; gives those that are kept, by their names."""
    storage, folder = Storage(tmp_path / "data"), tmp_path / "upload"
    folder.mkdir()
    upload = Upload(folder, 100, 100_000)
    for name, data in files.items():
        with upload.begin_file(name) as file:
            file.write(data)
    films_id = keep_films(storage, folder, upload, UploadLimits(most_files, most_bytes))
    assert storage.list_ids(AREA) == [films_id]
    kept = find_films(storage, films_id)
    assert kept is not None
    storage_files = {str(path.relative_to(kept)): path.read_bytes() for path in kept.rglob("*") if path.is_file()}
    storage.remove(AREA, films_id)
    assert find_films(storage, films_id) is None
    return storage_files


IMAGES = {"0.png": b"zero", "1.png": b"one"}


def test_plain_files_are_kept_as_they_are(tmp_path: Path) -> None:
    files = {"left.avi": b"left", "right/0.png": b"zero"}
    assert keep(tmp_path, files) == files


def test_one_archive_alone_is_what_is_in_it(tmp_path: Path) -> None:
    assert keep(tmp_path, {"all.ZIP": pack({f"left/{name}": data for name, data in IMAGES.items()})}) == {
        f"left/{name}": data for name, data in IMAGES.items()
    }


def test_an_archive_beside_others_becomes_a_camera_of_its_name(tmp_path: Path) -> None:
    kept = keep(tmp_path, {"left.zip": pack(IMAGES), "right.zip": pack(IMAGES), "top.avi": b"top"})
    assert kept == {f"{side}/{name}": data for side in ("left", "right") for name, data in IMAGES.items()} | {
        "top.avi": b"top"
    }


def test_an_archive_in_a_folder_stays_packed(tmp_path: Path) -> None:
    files = {"left/more.zip": pack(IMAGES), "right.avi": b"right"}
    assert keep(tmp_path, files) == files


def test_an_archive_of_the_name_of_a_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidError, match=r"left: two cameras have this name; rename one of them\. Nothing"):
        keep(tmp_path, {"left.zip": pack(IMAGES), "left/2.png": b"two"})


@pytest.mark.parametrize("limits", [{"most_files": 3}, {"most_bytes": 13}])
def test_archives_together_hold_no_more_than_is_allowed(tmp_path: Path, limits: dict[str, int]) -> None:
    """Each alone does: 2 files of 7 bytes together."""
    with pytest.raises(ImportRefusedError, match=r"right\.zip"):
        keep(tmp_path, {"left.zip": pack(IMAGES), "right.zip": pack(IMAGES)}, **limits)


def test_archives_that_are_exactly_as_large_as_allowed_are_taken(tmp_path: Path) -> None:
    kept = keep(tmp_path, {"left.zip": pack(IMAGES), "right.zip": pack(IMAGES)}, most_files=4, most_bytes=14)
    assert len(kept) == 4

"""Moving scans as rows, and the files of frames that can be used."""

from __future__ import annotations

import uuid
from pathlib import Path

import pytest

from server.errors import NotFoundError
from server.moving_scans.adding import AREA
from server.moving_scans.schemas import MovingScanPatch
from server.moving_scans.service import (
    delete_moving_scan,
    find_frame_view,
    find_scan_file,
    get_moving_scan,
    list_moving_scans,
    list_usable,
    update_moving_scan,
)
from server.storage import Storage
from tests.server.moving_scans.bench import Bench, bench

__all__ = ["bench"]


def test_a_deleted_one_is_told_from_one_that_never_was(bench: Bench) -> None:
    unknown = uuid.uuid4()
    delete_moving_scan(bench.session, bench.scan)
    with pytest.raises(NotFoundError, match=f"{bench.scan.id} was deleted; it can be restored from the bin"):
        get_moving_scan(bench.session, bench.scan.id)
    assert get_moving_scan(bench.session, bench.scan.id, deleted_too=True) is bench.scan
    for deleted_too in (True, False):
        with pytest.raises(NotFoundError, match=f"The moving scan {unknown} does not exist"):
            get_moving_scan(bench.session, unknown, deleted_too=deleted_too)


@pytest.mark.parametrize(
    ("search", "is_found"), [(None, True), ("wave", True), ("ADA waves", True), ("walks", False), ("%", False)]
)
def test_a_search_wants_each_word_in_the_name_or_the_person(bench: Bench, search, is_found: bool) -> None:
    found, _ = list_moving_scans(bench.session, search, None, 10)
    assert [row.id for row in found] == [bench.scan.id] * is_found


def test_what_a_change_leaves_out_stays(bench: Bench) -> None:
    update_moving_scan(bench.session, bench.scan, MovingScanPatch(name="Ada walks", fps=60.0))
    assert (bench.scan.name, bench.scan.subject, bench.scan.fps) == ("Ada walks", "Ada", 60.0)
    update_moving_scan(bench.session, bench.scan, MovingScanPatch(subject=""))
    assert (bench.scan.name, bench.scan.subject) == ("Ada walks", ""), "nobody is a person too"


def test_a_frame_has_its_file_and_one_that_cannot_be_used_no_picture(bench: Bench, tmp_path: Path) -> None:
    storage = Storage(tmp_path / "studio")
    bench.damage(2)
    folder = storage.folder(AREA, bench.scan.id)
    assert find_scan_file(storage, bench.scan, 2) == folder / "000002.ply"
    assert find_frame_view(storage, bench.scan, 1).parent == folder
    with pytest.raises(NotFoundError, match="Frame 2 of “Ada waves” cannot be shown: it holds no points"):
        find_frame_view(storage, bench.scan, 2)


@pytest.mark.parametrize("frame", [-1, 8])
@pytest.mark.parametrize("find", [find_scan_file, find_frame_view])
def test_a_frame_beside_the_scan_is_told_with_those_there_are(bench: Bench, tmp_path: Path, find, frame: int) -> None:
    with pytest.raises(NotFoundError, match=f"“Ada waves” has no frame {frame}; it has 0 to 7"):
        find(Storage(tmp_path / "studio"), bench.scan, frame)


def test_frames_that_cannot_be_used_are_left_out_of_a_stretch(bench: Bench) -> None:
    for frame in (0, 3, 7):
        bench.damage(frame)
    assert list_usable(bench.scan, 0, 7) == [1, 2, 4, 5, 6]
    assert (list_usable(bench.scan, 3, 3), list_usable(bench.scan, 3, 4)) == ([], [4])

"""Files become scans each by itself: what the list says wins, a file is kept once, and a refused one leaves nothing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import select

from server.access.audit import AuditRow
from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database, utc_now
from server.errors import InvalidError
from server.scans.adding import Added, ScanOptions, add_scans, make_options, parse_options
from server.scans.models import ScanRow
from server.scans.service import AREA
from server.storage import Storage
from server.storage.digest import compute_digest
from tests.server.curation import make_ball
from tracker.capture.scan import save_scan


@pytest.fixture
def storage(tmp_path: Path) -> Storage:
    return Storage(tmp_path / "studio")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Empty; what is put there can be added."""
    (tmp_path / "sent").mkdir()
    return tmp_path / "sent"


def put(folder: Path, name: str, seed: int = 0, radius: float = 0.08) -> Path:
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    save_scan(make_ball(seed, 600, radius), folder / name)
    return folder / name


def add(database: Database, storage: Storage, folder: Path, moves: bool = False, **options: Any) -> Added:
    return add_scans(database, storage, folder, ScanOptions(**options), LOCAL_ACCOUNT_ID, moves=moves)


def kept(storage: Storage) -> list[str]:
    return sorted(path.relative_to(storage.root / AREA).as_posix() for path in (storage.root / AREA).rglob("*.ply"))


def test_a_scan_is_measured_in_metres_and_its_file_stays_as_it_was(database, storage, folder) -> None:
    source = put(folder, "ball.ply", radius=80.0)
    [row] = add(database, storage, folder, metres_per_unit=0.001, subject="Ada", side="left").added
    assert (row.name, row.collection, row.subject, row.pose, row.side) == ("ball", "scans", "Ada", "", "left")
    assert (row.point_count, row.face_count, row.has_colors, row.removed_count) == (600, 0, False, 0)
    assert row.extent_m == pytest.approx([0.16] * 3, rel=0.05) and row.size_m == sorted(row.size_m or [], reverse=True)
    assert (row.metres_per_unit, row.first_metres_per_unit, row.is_unit_guessed) == (0.001, 0.001, False)
    stored = storage.folder(AREA, row.id) / row.file
    assert row.digest == compute_digest(source) == compute_digest(stored)
    assert row.byte_count == stored.stat().st_size
    with database.reading() as session:
        [act] = session.scalars(select(AuditRow))
        assert (act.act, act.subject_id, act.account_id, act.detail) == (
            *("scan.add", row.id, LOCAL_ACCOUNT_ID, {"name": "ball"}),
        )


def test_a_unit_that_nobody_said_is_recognised_by_the_size_and_noted_as_guessed(database, storage, folder) -> None:
    put(folder, "ball.ply", radius=80.0)
    [row] = add(database, storage, folder).added
    assert (row.metres_per_unit, row.is_unit_guessed) == (0.001, True)


@pytest.mark.parametrize("moves", [True, False])
def test_a_file_is_moved_only_where_it_may_be(database, storage, folder, moves: bool) -> None:
    source = put(folder, "ball.ply")
    add(database, storage, folder, moves)
    assert source.exists() != moves and len(kept(storage)) == 1


def test_what_the_list_says_wins_over_the_unit_of_a_file_and_that_over_the_unit_of_all(
    database, storage, folder
) -> None:
    for number, name in enumerate(("listed", "named", "other")):
        put(folder, f"{name}.ply", number)
    lines = [{"file": "listed.ply", "metres_per_unit": 1.0, "subject": "Ada", "name": "The first"}]
    (folder / "scans.json").write_text(json.dumps(lines))
    units = {"listed.ply": 2.0, "named.ply": 1.1}
    done = add(database, storage, folder, units=units, metres_per_unit=0.9, subject="Bob", pose="fist")
    assert {row.name: (row.subject, row.pose, row.metres_per_unit) for row in done.added} == {
        "The first": ("Ada", "fist", 1.0),
        "named": ("Bob", "fist", 1.1),
        "other": ("Bob", "fist", 0.9),
    }


@pytest.mark.parametrize(
    ("file", "name"),
    [("day1/a.b.ply", "day1/a.b"), ("a\tb.ply", "ab"), ("\t.ply", "scan"), ("x" * 240 + ".ply", "x" * 200)],
)
def test_a_scan_has_the_name_of_its_path_without_what_cannot_be_printed(database, storage, folder, file, name) -> None:
    put(folder, file)
    assert [row.name for row in add(database, storage, folder).added] == [name]


def test_a_file_that_is_no_scan_keeps_no_other_out_and_is_named_without_its_place(database, storage, folder) -> None:
    put(folder, "good.ply")
    (folder / "junk.ply").write_bytes(b"no scan")
    put(folder, "tiny.ply", 1, radius=1e-4)
    (folder / "notes.txt").write_text("x")
    done = add(database, storage, folder, metres_per_unit=1.0)
    assert [row.name for row in done.added] == ["good"] and done.notes == ["1 other file was ignored."]
    assert [one.file for one in done.refused] == ["junk.ply", "tiny.ply"]
    assert not any(str(folder) in one.detail for one in done.refused)
    assert len(kept(storage)) == 1 and len(storage.list_ids(AREA)) == 1, "a refused file leaves nothing behind"


def test_the_same_file_is_kept_once_in_a_collection_and_again_in_another(database, storage, folder) -> None:
    put(folder, "ball.ply")
    put(folder, "twin.ply")
    first = add(database, storage, folder)
    assert [row.name for row in first.added] == ["ball"] and [row.name for row in first.known] == ["ball"]
    again = add(database, storage, folder, collection="others")
    assert len(again.added) == 1 and again.added[0].id != first.added[0].id
    with database.writing() as session:
        session.get_one(ScanRow, first.added[0].id).deleted_at = utc_now()
    assert len(add(database, storage, folder).added) == 1, "a deleted one does not count"


def test_a_known_file_keeps_its_unit_and_says_so_where_another_was_said(database, storage, folder) -> None:
    put(folder, "ball.ply")
    add(database, storage, folder, metres_per_unit=1.0)
    assert add(database, storage, folder, metres_per_unit=1.0).notes == []
    assert add(database, storage, folder).notes == []
    [note] = add(database, storage, folder, metres_per_unit=1.25).notes
    assert note.startswith("ball.ply is there already as ball, with 1 unit = 1000 mm. It keeps that unit")


def test_options_are_what_they_are_without_any_and_refused_where_they_cannot_be() -> None:
    assert parse_options("") == parse_options("{}") == ScanOptions()
    assert parse_options('{"collection": "Lab", "units": {"a.ply": 0.01}}').units == {"a.ply": 0.01}
    for wrong in ({"collection": ""}, {"metres_per_unit": 1001}, {"units": {"a.ply": 0}}, {"colour": "red"}):
        with pytest.raises(InvalidError, match="What was given for the scans is wrong"):
            make_options(wrong)

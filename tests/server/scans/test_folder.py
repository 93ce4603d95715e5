"""Scans in a folder: found at any depth, with what each list beside them says, and what else lay there."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from server.errors import InvalidError
from server.scans import folder as folder_module
from server.scans.folder import find_scans


def write(folder: Path, *names: str) -> Path:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(b"x")
    return folder


def list_scans(path: Path, *lines: dict[str, object], in_object: bool = False) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"scans": lines} if in_object else lines))


def test_scans_of_every_kind_are_found_at_any_depth_in_the_order_of_their_names(tmp_path: Path) -> None:
    found = find_scans(write(tmp_path, "b/deep/two.OBJ", "a.ply", "b/three.Stl", "notes.txt", "b/noply"))
    assert list(found.scans) == ["a.ply", "b/deep/two.OBJ", "b/three.Stl"]
    assert found.scans["b/deep/two.OBJ"] == tmp_path / "b/deep/two.OBJ"
    assert (found.root, found.others, found.listed) == (tmp_path, 2, {})


def test_one_file_alone_is_a_folder_of_one(tmp_path: Path) -> None:
    write(tmp_path, "a.ply", "b.ply")
    found = find_scans(tmp_path / "a.ply")
    assert found.scans == {"a.ply": tmp_path / "a.ply"} and (found.root, found.others) == (tmp_path, 0)


def test_a_folder_without_scans_is_refused_with_what_would_be_one(tmp_path: Path) -> None:
    list_scans(write(tmp_path, "notes.txt") / "scans.json", {"file": "gone.ply"})
    with pytest.raises(InvalidError, match=r"There are no scans in it; needed files that end in \.ply, \.obj, \.stl"):
        find_scans(tmp_path)


@pytest.mark.parametrize("in_object", [False, True])
def test_a_list_names_files_from_where_it_lies(tmp_path: Path, in_object: bool) -> None:
    write(tmp_path, "a.ply", "day1/a.ply", "day1/more/b.ply")
    list_scans(tmp_path / "scans.json", {"file": "a.ply", "subject": "Ada"}, in_object=in_object)
    lines = {"file": "a.ply", "subject": "Bob", "side": "left"}, {"file": "more/b.ply", "metres_per_unit": 0.01}
    list_scans(tmp_path / "day1/scans.json", *lines, in_object=in_object)
    found = find_scans(tmp_path)
    assert {name: line.subject for name, line in found.listed.items()} == {
        "a.ply": "Ada",
        "day1/a.ply": "Bob",
        "day1/more/b.ply": "",
    }
    assert (found.listed["day1/a.ply"].side, found.listed["day1/more/b.ply"].metres_per_unit) == ("left", 0.01)
    assert found.others == 0, "a list is no file of another kind"


def test_what_a_list_says_beside_what_is_asked_is_passed_over(tmp_path: Path) -> None:
    list_scans(write(tmp_path, "a.ply") / "scans.json", {"file": "a.ply", "scanner": "ours"})
    assert find_scans(tmp_path).listed["a.ply"].pose == ""


@pytest.mark.parametrize("line", [{"file": "a.ply", "side": "both"}, {"file": "a.ply", "metres_per_unit": 0}, {}])
def test_a_line_that_says_something_impossible_is_refused_with_the_name_of_its_list(tmp_path: Path, line) -> None:
    list_scans(write(tmp_path, "day1/a.ply") / "day1/scans.json", line)
    with pytest.raises(InvalidError, match=r"^day1/scans\.json is wrong: .*; needed a list of objects with `file`"):
        find_scans(tmp_path)


def test_a_list_as_large_as_allowed_is_read_and_a_larger_one_is_not(tmp_path: Path, monkeypatch) -> None:
    list_scans(write(tmp_path, "a.ply") / "scans.json", {"file": "a.ply"})
    size = (tmp_path / "scans.json").stat().st_size
    monkeypatch.setattr(folder_module, "MAX_LIST_BYTES", size)
    assert len(find_scans(tmp_path).listed) == 1
    monkeypatch.setattr(folder_module, "MAX_LIST_BYTES", size - 1)
    with pytest.raises(InvalidError, match=rf"scans\.json has more than {size - 1} bytes"):
        find_scans(tmp_path)


@pytest.mark.parametrize(
    ("listed", "others", "told"),
    [
        (["a.ply"], [], []),
        (["a.ply"], ["x.txt"], ["1 other file was ignored."]),
        (["gone.ply"], [], ["scans.json names 1 file that is not there, such as 'gone.ply'."]),
        (
            ["a.ply", "b.ply", "c.ply"],
            ["x.txt", "y.txt"],
            ["scans.json names 2 files that are not there, such as 'b.ply'.", "2 other files were ignored."],
        ),
    ],
)
def test_notes_tell_what_is_missing_and_what_was_ignored(tmp_path: Path, listed, others, told) -> None:
    list_scans(write(tmp_path, "a.ply", *others) / "scans.json", *({"file": name} for name in listed))
    assert find_scans(tmp_path).write_notes() == told


def test_a_message_does_not_tell_where_the_folder_lies(tmp_path: Path) -> None:
    found = find_scans(write(tmp_path, "day1/a.ply"))
    assert found.hide_root(f"{tmp_path}/day1/a.ply: no vertices") == "day1/a.ply: no vertices"

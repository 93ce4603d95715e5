"""The files of a folder that somebody imports: plain ones inside it, from where the recording begins."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import tracker.capture.listed_files as listed_files
from tracker.capture.listed_files import find_root, list_files
from tracker.errors import ImportRefusedError


def touch(folder: Path, *names: str) -> Path:
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"x")
    return folder


def test_files_are_listed_by_relative_name_without_clutter(tmp_path: Path) -> None:
    touch(tmp_path, "b.png", "a/2.png", "a/1.png", ".hidden", "__MACOSX/a.png", "Thumbs.db", "a/desktop.ini", ".git/x")
    found = list_files(tmp_path)
    assert (found.names, found.refused, found.root) == (("a/1.png", "a/2.png", "b.png"), (), tmp_path)
    assert found.path("a/1.png") == tmp_path / "a/1.png"


def test_a_recording_begins_where_there_is_more_than_one_folder(tmp_path: Path) -> None:
    touch(tmp_path, "archive/recording/color/1.png", "archive/recording/depth/1.png", "archive/.DS_Store")
    assert find_root(tmp_path) == tmp_path / "archive/recording"
    assert list_files(tmp_path).names == ("color/1.png", "depth/1.png")
    one = tmp_path / "archive/recording/color/1.png"
    assert find_root(one) == one.parent and list_files(one).names == ("1.png",)


def test_links_out_and_pipes_are_refused_by_name_and_links_inside_are_files(tmp_path: Path) -> None:
    folder = touch(tmp_path / "recording", "a.png", "b.png")
    touch(tmp_path, "outside/secret.png")
    (folder / "inside.png").symlink_to(folder / "a.png")
    (folder / "out.png").symlink_to(tmp_path / "outside/secret.png")
    (folder / "folder").symlink_to(tmp_path / "outside")
    os.mkfifo(folder / "pipe")
    found = list_files(folder)
    assert found.names == ("a.png", "b.png", "inside.png")
    assert sorted(found.refused) == [
        "folder is a link to a folder",
        "out.png is a link out of the folder",
        "pipe is not a plain file",
    ]


def test_names_that_no_other_system_can_hold_are_refused(tmp_path: Path) -> None:
    (refused,) = list_files(touch(tmp_path, "a.png", "con.png", "b.png")).refused
    assert refused.startswith("'con.png'")


def test_too_many_and_too_deep_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listed_files, "MAX_FILES", 2)
    with pytest.raises(ImportRefusedError, match="more than 2 files"):
        list_files(touch(tmp_path / "many", "1", "2", "3"))
    deep = touch(tmp_path / "deep", "1.png", "/".join("abcdefghijklmno"))
    with pytest.raises(ImportRefusedError, match="nested more than 12 deep"):
        list_files(deep)
    with pytest.raises(ImportRefusedError, match="there is no such file"):
        list_files(tmp_path / "nowhere")

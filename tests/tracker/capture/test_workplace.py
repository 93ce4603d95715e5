"""A folder is whole in its place or not there at all."""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

import pytest

from tracker.capture.workplace import clean_leftovers, make_workplace

OLD = ".take.unfinished-" + "0" * 32


def list_names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def test_what_is_filled_in_becomes_the_destination_with_all_in_it(tmp_path: Path) -> None:
    destination = tmp_path / "deep/er/take"
    with make_workplace(destination) as folder:
        assert folder.parent == destination.parent and folder.name.startswith(".take.unfinished-")
        assert not destination.exists()
        (folder / "a").mkdir()
        (folder / "a/b.txt").write_text("whole")
    assert (destination / "a/b.txt").read_text() == "whole" and list_names(destination.parent) == ["take"]


def test_when_the_block_fails_nothing_is_there_and_the_failure_comes_through(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), make_workplace(tmp_path / "take") as folder:
        (folder / "half.txt").rename(folder / "nowhere" / "half.txt")
    assert list_names(tmp_path) == []


def test_an_empty_folder_may_be_replaced_and_a_full_one_is_left_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with make_workplace(tmp_path / "empty") as folder:
        (folder / "new.txt").write_text("new")
    assert list_names(tmp_path / "empty") == ["new.txt"]
    with pytest.raises(OSError, match=r"not empty|exists"), make_workplace(tmp_path / "empty") as folder:
        (folder / "other.txt").write_text("other")
    assert list_names(tmp_path / "empty") == ["new.txt"] and list_names(tmp_path) == ["empty"]


def test_two_at_once_for_one_destination_do_not_touch_each_other(tmp_path: Path) -> None:
    with make_workplace(tmp_path / "one") as first, make_workplace(tmp_path / "two") as second:
        assert first.is_dir() and first != second
        assert clean_leftovers(tmp_path) == [] and first.is_dir() and second.is_dir()
    assert list_names(tmp_path) == ["one", "two"]


def test_a_name_too_long_for_the_disk_with_its_ending_is_shortened(tmp_path: Path) -> None:
    name = "a" * 250
    with make_workplace(tmp_path / name) as folder:
        assert len(folder.name) < 200
    assert list_names(tmp_path) == [name]


def test_what_a_killed_one_left_is_removed_before_the_next_begins(tmp_path: Path) -> None:
    (tmp_path / OLD).mkdir()
    (tmp_path / OLD / "half.txt").write_text("half")
    with make_workplace(tmp_path / "other"):
        assert not (tmp_path / OLD).exists()


def test_only_leftovers_are_removed_and_told(tmp_path: Path) -> None:
    (tmp_path / OLD).mkdir()
    kept = [".take.unfinished-" + "0" * 31, ".take.unfinished-" + "G" * 32, "take.unfinished-" + "0" * 32, "mine"]
    for name in kept:
        (tmp_path / name).mkdir()
    (tmp_path / (".file.unfinished-" + "1" * 32)).write_text("a file")
    (tmp_path / (".link.unfinished-" + "2" * 32)).symlink_to(tmp_path / "mine")
    before = list_names(tmp_path)
    assert clean_leftovers(tmp_path) == [tmp_path / OLD]
    assert list_names(tmp_path) == [name for name in before if name != OLD]


def test_one_that_somebody_still_fills_is_left_until_it_is_given_up(tmp_path: Path) -> None:
    (tmp_path / OLD).mkdir()
    descriptor = os.open(tmp_path / OLD, os.O_RDONLY)
    fcntl.flock(descriptor, fcntl.LOCK_EX)
    assert clean_leftovers(str(tmp_path)) == []
    os.close(descriptor)
    assert clean_leftovers(str(tmp_path)) == [tmp_path / OLD]

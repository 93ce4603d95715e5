"""A plan's name is printable and never empty; a camera has the streams that it has, colour first."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tracker.capture.image_files import ImageFiles
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import PlannedCamera, default_name
from tracker.capture.listed_files import ListedFiles

FOLDER = ListedFiles(Path("/data/waving hand"), ())


@pytest.mark.parametrize(
    ("told", "name"),
    [(None, "waving hand"), ("", "waving hand"), ("  ball ", "ball"), ("a\tb\n", "ab"), ("\x00", "recording")],
)
def test_the_name_is_the_one_that_was_told_or_the_folders_without_control_signs(told: str | None, name: str) -> None:
    assert default_name(FOLDER, ImportOptions(name=told)) == name


@example("a" * 199 + " b")
@settings(max_examples=40)
@given(st.text(max_size=400))
def test_any_name_becomes_one_that_can_be_shown(told: str) -> None:
    name = default_name(FOLDER, ImportOptions(name=told))
    assert name.isprintable() and 0 < len(name) <= 200 and name == name.strip()


def test_a_folder_without_a_name_is_a_recording() -> None:
    assert default_name(ListedFiles(Path("/"), ()), ImportOptions()) == "recording"


def test_streams_come_with_colour_first_and_only_where_there_are_images(tmp_path: Path) -> None:
    color, depth = (ImageFiles(tmp_path, (), is_depth) for is_depth in (False, True))
    assert list(PlannedCamera("a", None, color=color, depth=depth).streams()) == [("color", color), ("depth", depth)]
    assert list(PlannedCamera("a", None, depth=depth).streams()) == [("depth", depth)]
    assert list(PlannedCamera("a", None).streams()) == []

"""A file name means the image that its longest known end means, whoever renamed the folders above it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.label_formats.conftest import FRAMES, make_sequence
from tracker.label_formats.image_names import ImageNames, list_image_names

NAMES = list_image_names(make_sequence(2))
places = st.tuples(st.sampled_from(("cam0", "cam1")), st.integers(0, FRAMES - 1))
folders = st.lists(st.text(st.characters(codec="ascii", categories=("Lu", "Ll", "Nd")), min_size=1), max_size=3)


@given(places)
def test_the_name_of_a_place_means_that_place(place) -> None:
    assert NAMES.find(NAMES.name(place)) == [place]


@given(places, folders, st.booleans())
def test_folders_above_it_windows_slashes_and_capitals_do_not_matter(place, above, is_windows) -> None:
    name = "/".join([*above, NAMES.name(place)]).upper()
    assert NAMES.find(name.replace("/", "\\") if is_windows else name) == [place]


@given(st.integers(0, FRAMES - 1))
def test_a_name_without_its_folder_means_a_frame_of_every_camera_until_one_is_named(frame) -> None:
    name = f"{frame:06d}.png"
    both = [("cam0", frame), ("cam1", frame)]
    assert NAMES.find(name) == both
    assert NAMES.find(name, "cam1") == [("cam1", frame)]
    assert NAMES.find(f"exported/cam0/images/{name}") == [("cam0", frame)], "the camera in the path is a hint"
    assert NAMES.find(name, "cam7") == both, "a camera that there is not tells nothing"


@pytest.mark.parametrize("name", ["", "/", "000099.png", "color", "..", "cam0/color/000001.jpg"])
def test_any_other_name_means_no_image(name) -> None:
    assert NAMES.find(name) == []


def test_original_names_stand_before_stored_ones() -> None:
    names = ImageNames({("cam0", 0): "shots/IMG_1.JPG", ("cam0", 1): "000000.png"}, NAMES.stored)
    assert names.name(("cam0", 0)) == "shots/IMG_1.JPG" and names.name(("cam1", 0)) == "cam1/color/000000.png"
    assert names.find("img_1.jpg") == [("cam0", 0)]
    assert names.find("000000.png") == [("cam0", 1)]
    assert names.find("cam1/color/000000.png") == [("cam1", 0)], "the longer end decides before that"


def noted(folder: Path, document: object) -> dict[tuple[str, int], str]:
    (folder / "sources.json").write_text(json.dumps(document))
    return list_image_names(replace(make_sequence(1), folder=folder)).originals


def test_what_an_import_noted_of_files_counts_and_frames_of_videos_have_no_file(tmp_path) -> None:
    entries = [
        {"source": "a/1.png"},
        {"source": "walk.mp4#1"},
        {"source": ""},
        {"source": 3},
        "x",
        {"source": "a/6.png"},
    ]
    document = {"cameras": {"cam0": {"color": [*entries, {"source": "beyond.png"}]}}}
    assert noted(tmp_path, document) == {("cam0", 0): "a/1.png", ("cam0", 5): "a/6.png"}


@pytest.mark.parametrize(
    "document",
    [[], {}, {"cameras": []}, {"cameras": {"cam0": 1}}, {"cameras": {"cam0": {"color": {"0": "x"}}}}],
    ids=str,
)
def test_a_note_of_another_form_is_passed_over(tmp_path, document) -> None:
    assert noted(tmp_path, document) == {}
    (tmp_path / "sources.json").write_bytes(b"\xff{")
    assert list_image_names(replace(make_sequence(1), folder=tmp_path)).originals == {}

"""Our own file holds everything of one recording, and a place that the recording has not is a problem."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.tracker.label_formats.conftest import FRAMES, MakeSet
from tracker.capture.annotations import Annotation
from tracker.capture.joint_source import JointSource
from tracker.errors import AnnotationError
from tracker.label_formats.handloom_json import read_handloom, write_handloom
from tracker.label_formats.label_set import ImportHints

MARKS = np.column_stack([np.arange(21) / 3, np.arange(21) + 0.1, np.tile([2.0, 1.0, 2.0], 7)])
SOURCES = (JointSource("triangulation", is_independent=True), None, JointSource("track", "Track 1"), *(None,) * 18)


def test_positions_occlusion_and_sources_come_back_to_the_bit(make_set: MakeSet) -> None:
    marks = MARKS.copy()
    marks[3:5] = [[0, 0, 0], [-1, -1, 0]]
    made = write_handloom([make_set((Annotation(2, "cam1", "left", marks, SOURCES),))])
    assert (made.items, made.joints, made.notes) == (1, 19, ())
    found = read_handloom(made.files, [make_set()], ImportHints())
    (item,) = found.annotations["a" * 8].items
    assert item.key == (2, "cam1", "left") and item.sources == SOURCES
    assert np.array_equal(item.points, marks) and found.problems == found.warnings == ()


def test_no_labels_are_a_file_without_items(make_set: MakeSet) -> None:
    made = write_handloom([make_set()])
    assert (made.items, made.joints) == (0, 0) and json.loads(made.files["annotations.json"])["items"] == []
    assert read_handloom(made.files, [make_set()], ImportHints()).annotations["a" * 8].items == ()


def test_places_that_the_recording_does_not_have_are_a_problem_and_named(make_set: MakeSet) -> None:
    items = tuple(Annotation(frame, camera, "right", MARKS) for frame, camera in ((FRAMES, "cam0"), (0, "cam2")))
    inside = Annotation(FRAMES - 1, "cam1", "right", MARKS)
    files = write_handloom([make_set((*items, inside))]).files
    found = read_handloom(files, [make_set()], ImportHints())
    (problem,) = found.problems
    assert problem.startswith("2 hands are in images that the recording does not have (frame ")
    assert f"frame {FRAMES} of cam0" in problem and "frame 0 of cam2" in problem
    assert [item.key for item in found.annotations["a" * 8].items] == [inside.key]


@pytest.mark.parametrize(("centre", "is_taken"), [(None, True), (0.0, True), (0.5, False)])
def test_its_pixel_centres_are_whole_numbers_whatever_is_said(centre, is_taken: bool, make_set: MakeSet) -> None:
    files = write_handloom([make_set((Annotation(1, "cam0", "right", MARKS),))]).files
    if is_taken:
        (item,) = read_handloom(files, [make_set()], ImportHints(pixel_centre=centre)).annotations["a" * 8].items
        assert np.array_equal(item.points, MARKS)
    else:
        with pytest.raises(AnnotationError, match="whole numbers by contract; leave pixel_centre out"):
            read_handloom(files, [make_set()], ImportHints(pixel_centre=centre))

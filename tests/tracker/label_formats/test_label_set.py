"""Notes are counted in good English, and no hand that was read takes another's place."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.label_formats.conftest import make_sequence
from tests.tracker.label_formats.hands import points
from tracker.capture.annotations import Annotation
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.label_set import (
    MAX_NOTES,
    ImportCollector,
    LabelSet,
    Notes,
    count_joints,
    is_outside,
    note_flat_visibility,
)

KIND = "{n} [joint was|joints were] lost"


@pytest.mark.parametrize(("count", "said"), [(0, ()), (1, ("1 joint was lost.",)), (3, ("3 joints were lost.",))])
def test_a_kind_is_told_once_with_its_number_in_the_words_that_fit_it(count, said) -> None:
    notes = Notes()
    notes.add(KIND, count=count)
    assert notes.sentences() == said


@given(st.lists(st.sampled_from("abcdefgh"), min_size=1, max_size=30))
def test_the_first_five_examples_are_shown_and_dots_when_there_are_more(examples) -> None:
    notes = Notes()
    for example in examples:
        notes.add("{n} seen", example)
    shown = ", ".join(examples[:5]) + (", ..." if len(examples) > 5 else "")
    assert notes.sentences() == (f"{len(examples)} seen ({shown}).",)


@given(st.integers(1, 60))
def test_never_more_than_so_many_kinds_are_told_and_the_rest_are_counted(kinds) -> None:
    notes = Notes()
    for number in range(kinds):
        notes.add(f"{{n}} of kind {number}")
    told = notes.sentences()
    assert len(told) == min(kinds, MAX_NOTES + 1)
    if kinds > MAX_NOTES:
        assert told[-1].startswith(f"{kinds - MAX_NOTES} further kind")


def collector() -> ImportCollector:
    sequence = make_sequence(2)
    return ImportCollector([LabelSet("key", sequence, list_image_names(sequence))])


@given(points(), points())
def test_two_hands_for_one_place_are_a_problem_and_the_first_stays(first, second) -> None:
    found = collector()
    for marks in (first, second):
        found.add("key", Annotation(3, "cam1", "left", marks))
    labels = found.finish()
    (kept,) = labels.annotations["key"].items
    assert np.array_equal(kept.points, first)
    (problem,) = labels.problems
    assert "1 place has two hands" in problem and "the left hand in frame 3 of cam1" in problem


def test_a_hand_without_a_joint_says_nothing_but_one_that_is_outside_does() -> None:
    found = collector()
    empty, outside = np.zeros((21, 3)), np.zeros((21, 3))
    outside[4, :2] = -1.0
    found.add("key", Annotation(0, "cam0", "right", empty))
    found.add("key", Annotation(1, "cam0", "right", outside))
    labels = found.finish()
    assert [item.frame for item in labels.annotations["key"].items] == [1] and labels.problems == ()
    assert labels.warnings == ("1 hand without a single joint was left out.",)


@given(points())
def test_what_a_flat_format_loses_is_each_occluded_joint_and_each_one_outside(marks) -> None:
    item, notes = Annotation(0, "cam0", "right", marks), Notes()
    note_flat_visibility(notes, [item], "COCO")
    occluded, outside = int((marks[:, 2] == 1).sum()), int(is_outside(marks).sum())
    told = " ".join(notes.sentences())
    assert (f"{occluded} occluded joint" in told) == (occluded > 0)
    assert (f"{outside} joint" in told) == (outside > 0) or occluded == outside
    assert count_joints([item, item]) == 2 * int((marks[:, 2] > 0).sum())

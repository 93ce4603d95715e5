"""Nothing is judged by what it made itself: which joints count by where they came from."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.annotations import Annotation, Annotations
from tracker.capture.joint_source import SOURCE_KINDS, JointSource
from tracker.capture.source_choice import (
    MADE,
    SOURCE_CHOICES,
    choose_sources,
    count_origins,
    describe_origin,
    find_counted,
    is_independent,
    keep_joints,
    say_left_out,
)
from tracker.errors import AnnotationError

SOURCES = st.one_of(st.none(), st.builds(JointSource, st.sampled_from(SOURCE_KINDS), is_independent=st.booleans()))
HANDS = st.one_of(st.none(), st.tuples(*[SOURCES] * 21))


def label(sources: tuple[JointSource | None, ...] | None, placed: int = 21) -> Annotation:
    points = np.zeros((21, 3))
    points[:placed] = [5.0, 6.0, 2.0]
    return Annotation(3, "cam0", "right", points, sources=sources)


@pytest.mark.parametrize("kind", MADE)
@pytest.mark.parametrize("says_independent", [True, False])
def test_what_the_tracker_has_a_part_in_is_never_independent(kind: str, says_independent: bool) -> None:
    assert not is_independent(JointSource(kind, is_independent=says_independent))


@pytest.mark.parametrize("kind", ["triangulation", "interpolation", "copy"])
def test_what_is_made_of_joints_is_as_independent_as_they_are(kind: str) -> None:
    assert is_independent(JointSource(kind, is_independent=True)) and not is_independent(JointSource(kind))


def test_joints_placed_by_hand_or_imported_are_independent() -> None:
    assert is_independent(None) and is_independent(JointSource("import"))


@given(HANDS, st.lists(st.sampled_from(SOURCE_CHOICES), min_size=1))
def test_a_joint_counts_that_is_among_any_of_the_choices(sources, chosen: list[str]) -> None:
    whole = find_counted(sources, chosen)
    assert whole.shape == (21,)
    np.testing.assert_array_equal(whole, np.any([find_counted(sources, [one]) for one in chosen], axis=0))
    assert find_counted(sources, ["all"]).all()
    origins = ("hand", "unknown", *SOURCE_KINDS)
    assert (np.sum([find_counted(sources, [one]) for one in origins], axis=0) == 1).all(), "each is of one origin"


@given(HANDS, st.integers(0, 21), st.lists(st.sampled_from(SOURCE_CHOICES), min_size=1))
def test_every_placed_joint_is_kept_or_told_of(sources, placed: int, chosen: list[str]) -> None:
    item = label(sources, placed)
    kept, gone = keep_joints(Annotations((item,)), chosen)
    left = sum(int((one.points[:, 2] > 0).sum()) for one in kept.items)
    assert left + sum(count for _, count in gone) == placed
    for one in kept.items:
        counted = find_counted(sources, chosen)
        assert not one.points[~counted].any()
        assert one.sources is None or all(s is None for s, c in zip(one.sources, counted, strict=True) if not c)


def test_a_hand_without_any_joint_left_is_left_out_whole_but_an_empty_label_stays() -> None:
    made = label((JointSource("track", "Track 2"),) * 21)
    kept, gone = keep_joints(Annotations((made,)), ["independent"])
    assert kept.items == () and gone == [("accepted from Track 2", 21)]
    assert len(keep_joints(Annotations((label(made.sources, 0),)), ["independent"])[0].items) == 1


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (None, "placed by hand"),
        (JointSource("track", "Track 2"), "accepted from Track 2"),
        (JointSource("track"), "accepted from a track"),
        (JointSource("copy"), "copied from another frame and not known to be free of a track"),
        (JointSource("copy", is_independent=True), "copied from another frame"),
        (JointSource("import"), "imported"),
    ],
)
def test_an_origin_is_said_in_words(source: JointSource | None, words: str) -> None:
    assert describe_origin((source,) * 21, 0) == words
    assert describe_origin(None, 0) == "of unknown origin"


def test_what_is_left_out_is_said_in_one_sentence_the_most_frequent_first() -> None:
    counts = count_origins(["imported", "placed by hand", "imported"])
    assert say_left_out(counts) == ("3 joints are left out because of their source: 2 imported, 1 placed by hand.")
    assert say_left_out([]) == ""


def test_choices_are_words_with_commas_between() -> None:
    assert choose_sources(" hand, import ,") == ("hand", "import")
    for text in ("", ",", "hand,feet"):
        with pytest.raises(AnnotationError, match="needed one or more of independent, all, hand"):
            choose_sources(text)

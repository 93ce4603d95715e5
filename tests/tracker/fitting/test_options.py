"""Options of a run: each within its bounds, with what forms need, and given back as it came."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.errors import TrackingError
from tracker.fitting.options import TERMS, TrackOptions


def test_every_option_has_a_label_and_help_and_its_default_is_allowed() -> None:
    for option in fields(TrackOptions):
        assert option.metadata["label"] and option.metadata["help"].endswith("."), option.name
        choices = option.metadata.get("choices")
        assert choices is None or (option.default in choices and len(choices) == len(option.metadata["choice_labels"]))
    assert TrackOptions.from_json({}) == TrackOptions()


@given(st.sampled_from(TERMS), st.integers(1, 200), st.booleans(), st.one_of(st.integers(0, 100), st.floats(0, 100)))
def test_options_are_given_back_as_they_came(terms: str, iterations: int, recover: bool, stop: float) -> None:
    options = TrackOptions(terms=terms, iterations=iterations, recover=recover, stop_below_mm=stop)
    assert TrackOptions.from_json(options.to_json()) == options
    assert set(options.term_letters) <= set("SCP") and f"LO+{options.term_letters}".rstrip("+") == terms


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"iteration": 3}, "There is no option 'iteration'; there are terms"),
        ({"terms": "SC"}, "terms is 'SC'; needed one of LO"),
        ({"iterations": 0}, "needed a number from 1 to 200"),
        ({"iterations": 2.0}, "iterations is 2.0; needed a whole number"),
        ({"iterations": True}, "needed a whole number"),
        ({"recover": 1}, "needed true or false"),
        ({"stop_below_mm": "1"}, "needed a number"),
        ({"stop_below_mm": float("nan")}, "needed a number from 0.0 to 100.0"),
        ({"threads": 65}, "from 1 to 64"),
        ({"first_frame": 9, "last_frame": 3}, "The last frame, 3, comes before the first, 9"),
    ],
)
def test_what_makes_no_sense_is_refused_by_its_name(values: dict[str, Any], told: str) -> None:
    with pytest.raises(TrackingError, match=told):
        TrackOptions.from_json(values)


@given(st.integers(1, 50), st.integers(0, 60), st.integers(-1, 60))
def test_the_frames_are_those_asked_for_or_the_recording_is_too_short(count: int, first: int, last: int) -> None:
    if 0 <= last < first:
        return
    options, end = TrackOptions(first_frame=first, last_frame=last), count - 1 if last < 0 else last
    if first <= end < count:
        assert options.frame_range(count) == range(first, end + 1)
    else:
        with pytest.raises(TrackingError, match=f"the recording has 0 to {count - 1}"):
            options.frame_range(count)


def test_cameras_are_ids_with_commas_between() -> None:
    assert TrackOptions(cameras=" cam0, cam1 ,").view_ids == ("cam0", "cam1")
    assert TrackOptions().view_ids == ()


def test_the_papers_algorithm_keeps_full_meshes() -> None:
    assert TrackOptions(method="t16").max_faces is None and TrackOptions().max_faces

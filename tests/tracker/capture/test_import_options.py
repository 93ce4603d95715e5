"""What people say at an import is read value by value; nothing that is not known is passed over."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.import_options import ImportOptions
from tracker.errors import ImportRefusedError

SAID: dict[str, Any] = {
    "name": "two hands", "fps": 30.0, "fx": 570.0, "fy": 571.0, "cx": 319.5, "cy": 239.5, "distortion": [0.1, 0, 0, 0],
    "intrinsics": "freiburg1", "preset": "kinect_v1", "depth_scale": 0.001, "depth_pattern": "depth/*.png",
    "color_pattern": "none", "hands": ["right"], "allow_gaps": True, "world_unit_m": 0.03, "object_unit_m": 0.001,
    "camera_shifts": "cam1=+3", "color_format": "png",
}  # fmt: skip


def test_every_option_has_its_help_and_is_given_back_as_it_was_said() -> None:
    assert set(SAID) == {field.name for field in fields(ImportOptions)}
    assert all(field.metadata["help"].endswith(".") for field in fields(ImportOptions))
    assert ImportOptions.from_json(SAID).to_json() == SAID


@given(st.sets(st.sampled_from(sorted(SAID))))
def test_what_was_not_said_stays_unsaid(names: set[str]) -> None:
    some = {name: SAID[name] for name in names}
    assert ImportOptions.from_json(some).to_json() == some
    assert ImportOptions.from_json(dict.fromkeys(names, "")) == ImportOptions(), "an empty field of a form"
    assert ImportOptions.from_json(dict.fromkeys(names)) == ImportOptions()


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ({"fbs": 30}, "unknown fbs; known: allow_gaps"),
        ([], "an object"),
        ({"fps": 0}, "fps is 0; needed a number from 0.001"),
        ({"fps": "30"}, "fps is '30'"),
        ({"fx": -1}, "fx is -1"),
        ({"depth_scale": 2}, "depth_scale is 2; needed a number from 1e-07 to 1"),
        ({"hands": ["right", "right"]}, "each hand once"),
        ({"hands": "right"}, "a list"),
        ({"hands": ["both"]}, "one of right, left"),
        ({"allow_gaps": 1}, "true or false"),
        ({"intrinsics": "freiburg9"}, "one of freiburg1"),
        ({"color_format": "gif"}, "one of jpeg, png"),
        ({"distortion": [0] * 15}, "at most 14"),
        ({"camera_shifts": "cam1"}, "cam1"),
        ({"name": " "}, "a text"),
    ],
)
def test_what_makes_no_sense_is_refused_by_its_name(said: Any, told: str) -> None:
    with pytest.raises(ImportRefusedError, match=told):
        ImportOptions.from_json(said)

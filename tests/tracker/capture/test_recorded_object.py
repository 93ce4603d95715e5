"""An object's entry in `sequence.json` comes back as it was written, placed or not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.document import Node
from tracker.capture.recorded_object import RecordedObject, parse_object
from tracker.errors import CalibrationError, SequenceError
from tracker.geometry.se3 import exp

PLACED = exp(np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]))


def parse(entry: Any) -> RecordedObject:
    return parse_object(Node(entry, "sequence.json", "objects[0]", SequenceError))


@given(st.booleans(), st.sampled_from([{}, {"lid": np.array([0.1, 0.0, 0.5])}]), st.sampled_from([None, 0.001]))
def test_what_is_written_is_read_again(is_placed: bool, joints: dict, unit: float | None) -> None:
    written = RecordedObject("box", "models/box.obj", PLACED if is_placed else None, joints, unit).to_json()
    assert parse(written).to_json() == written
    assert ("initial" in written) == (is_placed or bool(joints))


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"name": ""}, "a text"),
        ({"model": "../box.obj"}, r"objects\[0\]\.model"),
        ({"metres_per_unit": 0}, "a number from 1e-06 to 1000"),
        ({"initial": {"T_world_object": np.diag([2.0, 2, 2, 1]).tolist()}}, "not a rotation"),
        ({"initial": {"joints": {"lid": [1, 2]}}}, "three numbers, m"),
        ({"initial": {"joints": {"lid": [1, 2, 3000]}}}, "from -1000 to 1000"),
        ({"initial": {"joints": {str(bone): [0, 0, 0] for bone in range(1001)}}}, "at most 1000 bones"),
    ],
)
def test_an_entry_that_is_none_is_refused(changes: dict[str, Any], told: str) -> None:
    with pytest.raises((SequenceError, CalibrationError), match=told):
        parse({"name": "box", "model": "box.obj"} | changes)

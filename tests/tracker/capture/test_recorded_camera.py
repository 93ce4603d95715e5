"""A camera's entry in `sequence.json` comes back as it was written, and says what is wrong with it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker.capture.document import Node
from tracker.capture.recorded_camera import parse_camera
from tracker.errors import CalibrationError, SequenceError
from tracker.geometry.se3 import exp

ENTRY: dict[str, Any] = {
    "id": "cam0",
    "width": 640,
    "height": 480,
    "K": [[600.0, 0.0, 320.0], [0.0, 600.0, 240.0], [0.0, 0.0, 1.0]],
    "distortion": [0.1, 0.0, 0.0, 0.0],
    "T_world_camera": np.eye(4).tolist(),
    "color": "color/{:06d}.png",
    "depth": "depth/{:06d}.png",
    "depth_scale": 0.001,
}


def parse(**changes: Any):
    entry = {name: value for name, value in (ENTRY | changes).items() if value is not None}
    return parse_camera(Node(entry, "sequence.json", "cameras[0]", SequenceError))


@given(
    hnp.arrays(np.float64, 6, elements=st.floats(-3, 3)),
    st.from_regex(r"[a-zA-Z0-9][a-zA-Z0-9_-]{0,20}", fullmatch=True),
    st.sampled_from([{}, {"color": None}, {"depth": None, "depth_scale": None}, {"color": None, "film": "cam0.mp4"}]),
)
def test_what_is_written_is_read_again(twist: np.ndarray, name: str, changes: dict[str, Any]) -> None:
    reserved = {"con", "prn", "aux", "nul"}
    if name.lower() in reserved or name.lower()[:3] in ("com", "lpt"):
        return
    entry = ENTRY | changes | {"id": name, "T_world_camera": exp(twist).tolist()}
    camera = parse(**entry)
    assert camera.to_json() == {key: value for key, value in entry.items() if value is not None}
    assert camera.has_depth == (entry["depth"] is not None)
    assert camera.has_color == (entry["color"] is not None or "film" in entry)


def test_a_camera_without_a_place_stands_at_the_origin_without_distortion() -> None:
    camera = parse(T_world_camera=None, distortion=None)
    assert camera.T_world_camera.tolist() == np.eye(4).tolist() and camera.distortion.size == 0


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"color": None, "depth": None}, "neither 'color' nor 'depth' nor 'film'"),
        ({"film": "a.mp4"}, "both 'color' and 'film'"),
        ({"depth": ENTRY["color"]}, "are the same files"),
        ({"depth": "depth/{:06d}.jpg"}, "depth"),
        ({"color": "../{:06d}.png"}, "color"),
        ({"color": "color/1.png"}, "color"),
        ({"color": None, "film": "/etc/a.mp4"}, "film"),
        ({"color": None, "film": "a.txt"}, "a video"),
        ({"depth_scale": None}, "has no 'depth_scale'"),
        ({"depth_scale": 2.0}, "a number from 1e-07 to 1"),
        ({"id": "a/b"}, "letters, digits"),
        ({"id": ".a"}, "a letter or digit first"),
        ({"id": "con"}, "a name that can be a folder"),
        ({"width": 4}, "a whole number from 8"),
        ({"K": [[1, 0], [0, 1]]}, "3 rows of 3"),
        ({"K": None}, "has no 'K'"),
    ],
)
def test_an_entry_that_is_none_is_refused(changes: dict[str, Any], told: str) -> None:
    with pytest.raises((SequenceError, CalibrationError), match=told):
        parse(**changes)

"""Calibrations with OpenCV's names: one camera, a pair, a list or a table each; YAML, JSON and npz say the same."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.opencv_calibration import find_cameras, parse_opencv
from tracker.capture.video_calibration import VideoCamera
from tracker.errors import CalibrationError

K = [[30.0, 0, 16], [0, 31, 12], [0, 0, 1]]
TURN = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
YAML = """%YAML:1.0
---
camera_matrix: !!opencv-matrix   # OpenCV's own
   rows: 3
   cols: 3
   dt: d
   data: [ 30., 0., 16., 0., 31., 12.,
       0., 0., 1. ]
"dist-coeffs": [0.1, 0.2, 0, 0]
image_width: 32
image_height: 24
"""


def read(value: Any, file: str = "a.json") -> list[VideoCamera]:
    data = value if isinstance(value, bytes) else json.dumps(value).encode()
    return find_cameras(parse_opencv(data, file), file, "whole")


def test_the_three_kinds_of_file_give_the_same_camera() -> None:
    values = {"K": K, "dist": [0.1, 0.2, 0, 0], "size": [32, 24]}
    packed = io.BytesIO()
    np.savez(packed, allow_pickle=False, **{name: np.array(value) for name, value in values.items()})
    for data, file in ((YAML.encode(), "a.yml"), (json.dumps(values).encode(), "a.json"), (packed.getvalue(), "a.npz")):
        (camera,) = read(data, file)
        assert (camera.name, camera.K.tolist(), camera.size) == ("whole", K, (32, 24)), file
        assert camera.distortion.tolist() == [0.1, 0.2, 0, 0], file


@given(st.sampled_from(["K", "mtx", "camera_matrix", "cameraMatrix", "Camera-Matrix"]), st.sampled_from(["R", "rvec"]))
def test_a_meaning_has_many_names(matrix: str, rotation: str) -> None:
    (camera,) = read({matrix: K, rotation: [0, 0, np.pi / 2] if rotation == "rvec" else TURN, "note": 1})
    np.testing.assert_allclose(camera.R, TURN, atol=1e-12)


def test_of_a_stereo_pair_the_first_camera_is_the_world() -> None:
    pair = {"K1": K, "K2": K, "R": TURN, "T": [1, 2, 3], "R1": np.eye(3).tolist(), "R2": TURN, "size": [32, 24]}
    first, second = read(pair)
    assert (first.name, second.name, first.size, second.size) == ("1", "2", (32, 24), (32, 24))
    assert first.R.tolist() == np.eye(3).tolist() and first.t.tolist() == [0, 0, 0]
    assert second.R.tolist() == TURN and second.t.tolist() == [1, 2, 3]


def test_three_numbered_cameras_have_their_own_places() -> None:
    cameras = read({f"K{n}": K for n in (2, 0, 1)} | {"R1": TURN, "R": np.eye(3).tolist(), "t": [9, 9, 9]})
    assert [camera.name for camera in cameras] == ["0", "1", "2"]
    assert [camera.R.tolist() == TURN for camera in cameras] == [False, True, False]
    assert all(camera.t.tolist() == [0, 0, 0] for camera in cameras)


def test_cameras_that_have_a_table_each_are_named_by_it() -> None:
    listed = [{"id": "top", "K": K}, {"name": "side", "K": K}, {"K": K}]
    assert (
        [camera.name for camera in read(listed)] == ["top", "side", "2"] == [c.name for c in read({"cameras": listed})]
    )
    tables = {"left": {"K": K}, "lens": {"focal": 3}, "right": {"K": K}}
    assert [camera.name for camera in read(tables)] == ["left", "right"]


def test_values_without_a_camera_matrix_make_no_camera() -> None:
    assert read({"R": TURN, "date": "today", "cameras": []}) == []


@pytest.mark.parametrize(
    ("data", "file", "told"),
    [
        (b"3", "a.json", "needed an object"),
        (b'[{"dist": [1]}]', "a.json", "camera 0 has no camera matrix"),
        (b"K: [1, 2", "a.yml", "line 1: the list does not end"),
        (b"K 1", "a.yml", "line 1: is 'K 1'; needed 'name: value'"),
        (b"\n".join(b" " * n + b"a:" for n in range(9)), "a.yml", "line 9: is nested too deeply"),
        (b"not a zip", "a.npz", "needed an npz of arrays"),
        (b"K: [[1, 0], [0, 1]]", "a.yml", r"K has shape \(2, 2\)"),
    ],
)
def test_files_that_make_no_camera_say_why(data: bytes, file: str, told: str) -> None:
    with pytest.raises(CalibrationError, match=told):
        read(data, file)


@given(st.text(st.sampled_from('K:[]0123.,- \n"cameras{}RT#!'), max_size=80), st.sampled_from(["a.yml", "a.json"]))
def test_any_text_makes_cameras_or_an_error_that_names_the_file(text: str, file: str) -> None:
    try:
        assert all(np.isfinite(camera.find_pose(1.0)).all() for camera in read(text.encode(), file))
    except CalibrationError as refusal:
        told = str(refusal)
    else:
        return
    assert file in told

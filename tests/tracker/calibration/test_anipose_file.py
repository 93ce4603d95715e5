"""Anipose's file as it is written: reals, five coefficients, names and offsets as they were, metres."""

from __future__ import annotations

import tomllib

import cv2
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.tracker.calibration.filmed_board import film
from tracker.calibration.anipose_file import write_anipose
from tracker.capture.anipose_calibration import parse_anipose
from tracker.capture.camera import Camera

CAMERAS = film(3).cameras
K = np.array([[500.0, 0.0, 320.0], [0.0, 500.0, 240.0], [0.0, 0.0, 1.0]])
NAMES = st.text(st.characters(codec="utf-8"), min_size=1, max_size=8)


def test_all_numbers_but_the_size_are_reals_whole_ones_too() -> None:
    table = tomllib.loads(write_anipose([Camera("a", 640, 480, K)]).decode())["cam_0"]
    lists = [*table["matrix"], table["distortions"], table["rotation"], table["translation"]]
    assert {type(number) for numbers in lists for number in numbers} == {float} and table["size"] == [640, 480]
    assert table["distortions"] == [0.0] * 5, "Anipose wants five where there are none"


def test_rotation_and_translation_take_the_world_to_the_camera() -> None:
    tables = tomllib.loads(write_anipose(CAMERAS).decode())
    for number, camera in enumerate(CAMERAS):
        turn, move = (np.array(tables[f"cam_{number}"][name]) for name in ("rotation", "translation"))
        assert np.allclose(cv2.Rodrigues(turn)[0], camera.T_camera_world[:3, :3], atol=1e-12)
        assert np.allclose(move, camera.T_camera_world[:3, 3])


@settings(max_examples=25)
@given(NAMES)
@example("hand \U0001f590")
@example('"\x7f\\\n')
def test_any_name_of_a_camera_comes_back(name: str) -> None:
    data = write_anipose([Camera(name, 640, 480, K)], (0.125,))
    (camera,) = parse_anipose(data, "calibration.toml")
    assert camera.name == name and camera.offset_s == 0.125


def test_offsets_stand_in_the_metadata_by_the_cameras_names_and_only_when_there_are_some() -> None:
    metadata = tomllib.loads(write_anipose(CAMERAS, (0.0, -0.25, 1e-7), 0.37).decode())["metadata"]
    assert metadata["time_offsets_s"] == {"cam0": 0.0, "cam1": -0.25, "cam2": 1e-7}
    assert (metadata["unit"], metadata["adjusted"], metadata["error"]) == ("m", True, 0.37)
    assert "time_offsets_s" not in tomllib.loads(write_anipose(CAMERAS).decode())["metadata"]


@pytest.mark.parametrize("error", [0.0, 3.0, 1e-9, 1e22, float("nan"), float("inf")])
def test_an_error_is_written_as_toml_has_it_even_where_nothing_was_left_out(error: float) -> None:
    data = write_anipose(CAMERAS, error_px=error)
    assert np.array_equal(tomllib.loads(data.decode())["metadata"]["error"], error, equal_nan=True)


@settings(max_examples=10)
@given(st.lists(st.floats(-1e3, 1e3, allow_subnormal=False), min_size=5, max_size=5))
def test_no_digit_of_a_lens_is_lost(distortion: list[float]) -> None:
    lens = Camera("a", 640, 480, K / 3 + np.diag([0, 0, 2 / 3]), np.array(distortion))
    (camera,) = parse_anipose(write_anipose([lens]), "x")
    assert np.array_equal(camera.distortion, distortion) and camera.K[0, 0] == 500.0 / 3

"""Anipose's TOML: a table for each camera; ours says metres and offsets, and only then they count."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.anipose_calibration import LONGEST_OFFSET_S, parse_anipose
from tracker.errors import CalibrationError

CAMERA = """
[cam_{number}]
name = "{name}"
size = [640, 480]
matrix = [[500.0, 0.0, 319.5], [0.0, 500.0, 239.5], [0.0, 0.0, 1.0]]
distortions = [0.1, 0.0, 0.0, 0.0, 0.0]
rotation = [0.0, 0.0, 1.5707963267948966]
translation = [1.0, 2.0, 3.0]
"""
TWO = CAMERA.format(number=0, name="top") + CAMERA.format(number=1, name="side")


def parse(text: str) -> list:
    return parse_anipose(text.encode(), "calibration.toml")


def test_cameras_are_read_in_the_order_of_the_file() -> None:
    top, side = parse(TWO + "[metadata]\nadjusted = false\nerror = 0.3\n")
    assert (top.name, side.name, top.size, top.unit_m, top.offset_s) == ("top", "side", (640, 480), None, 0.0)
    np.testing.assert_allclose(top.R, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert top.t.tolist() == [1, 2, 3] and top.distortion.tolist() == [0.1, 0, 0, 0, 0]


def test_ours_says_metres_and_how_far_each_video_is_behind() -> None:
    ours = TWO + '[metadata]\nunit = "m"\ntime_offsets_s = {top = 0.0, side = -0.25}\n'
    assert [(camera.unit_m, camera.offset_s) for camera in parse(ours)] == [(1.0, 0.0), (1.0, -0.25)]
    assert [camera.offset_s for camera in parse(ours.replace('unit = "m"\n', ""))] == [0.0, 0.0]


@pytest.mark.parametrize("offset", ['"soon"', str(LONGEST_OFFSET_S + 1), "nan", "inf", "[1]"])
def test_an_offset_that_is_none_counts_as_none(offset: str) -> None:
    told = TWO + f'[metadata]\nunit = "m"\ntime_offsets_s = {{side = {offset}}}\n'
    assert [camera.offset_s for camera in parse(told)] == [0.0, 0.0]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "holds no camera"),
        ("[metadata]\nunit = 'm'", "holds no camera"),
        ("[cam_0", "needed valid TOML"),
        (TWO.replace("rotation = [0.0, 0.0, 1.5707963267948966]\n", "", 1), r"\[cam_0\] has no rotation"),
        (TWO.replace("size", "fisheye = true\nsize", 1), r"\[cam_0\] is a fisheye"),
        (TWO.replace("[1.0, 2.0, 3.0]", "[1.0]", 1), r"\[cam_0\]: t has 1 numbers"),
    ],
)
def test_files_that_hold_no_cameras_are_refused(text: str, told: str) -> None:
    with pytest.raises(CalibrationError, match=told):
        parse(text)


@given(st.text(st.sampled_from('[]cam_0="\n.matrix1{},'), max_size=60))
def test_any_text_is_refused_with_the_name_of_the_file(text: str) -> None:
    with pytest.raises(CalibrationError, match=r"calibration\.toml"):
        parse(text)

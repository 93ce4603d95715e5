"""COLMAP's text."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.capture.colmap_calibration import parse_colmap, to_wxyz
from tracker.errors import CalibrationError
from tracker.geometry.se3 import exp

CAMERAS = b"# a comment\n1 SIMPLE_RADIAL 640 480 500 320.5 240.5 0.1\n"
IMAGES = b"1 1 0 0 0 0 0 2 1 left/0001.png\n10 20 -1 30 40 -1\n2 1 0 0 0 0 0 2 1 left/0002.png\n\n"


def test_several_images_of_one_standing_camera_are_one_camera_named_after_their_folder() -> None:
    (camera,) = parse_colmap(CAMERAS, IMAGES, "cameras.txt")
    assert camera.name == "left" and camera.size == (640, 480)
    assert camera.K.tolist() == [[500, 0, 320], [0, 500, 240], [0, 0, 1]]
    assert camera.distortion.tolist() == [0.1, 0, 0, 0]
    assert np.allclose(camera.find_pose(1.0)[:3, 3], [0, 0, -2])


def test_a_rotation_comes_back_from_its_quaternion(rng: np.random.Generator) -> None:
    for turn in [*rng.normal(size=(20, 3)) * 2, np.array([np.pi, 0, 0]), np.zeros(3)]:
        R = exp(np.concatenate([np.zeros(3), turn]))[:3, :3]
        words = " ".join(repr(float(value)) for value in to_wxyz(R))
        (camera,) = parse_colmap(CAMERAS, f"1 {words} 0 0 0 1 a.png".encode(), "x")
        assert np.allclose(camera.R, R, atol=1e-9) and camera.name == "a"


@pytest.mark.parametrize(
    ("cameras", "images", "said"),
    [
        (CAMERAS, b"", "names no image"),
        (CAMERAS.replace(b"SIMPLE_RADIAL", b"OPENCV_FISHEYE"), IMAGES, "OPENCV_FISHEYE"),
        (CAMERAS.replace(b" 0.1", b""), IMAGES, "SIMPLE_RADIAL has 4 parameters; found 3"),
        (CAMERAS, IMAGES.replace(b"1 1 0 0 0", b"1 nan 0 0 0"), "quaternion"),
        (CAMERAS, IMAGES.replace(b"2 1 0 0 0 0 0 2", b"2 1 0 0 0 0 0 3"), "from different places"),
        (b"\xff\xfe", IMAGES, "damaged"),
        (CAMERAS, b"1 a b c d e f g 1 x.png", "damaged"),
    ],
)
def test_a_file_that_says_no_possible_camera_is_refused(cameras: bytes, images: bytes, said: str) -> None:
    with pytest.raises(CalibrationError, match=said):
        parse_colmap(cameras, images, "cameras.txt")

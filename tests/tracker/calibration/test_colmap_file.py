"""COLMAP's text: the simplest model that holds a lens, half a pixel more, one image in a folder of each camera."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.calibration.filmed_board import film
from tracker.calibration.colmap_file import write_colmap
from tracker.capture.colmap_calibration import parse_colmap
from tracker.errors import CalibrationError

CAMERA = film(2).cameras[1]


def list_lines(files: dict[str, bytes], name: str) -> list[list[str]]:
    return [line.split() for line in files[name].decode().splitlines() if not line.startswith("#")]


@pytest.mark.parametrize(
    ("distortion", "model", "count"),
    [
        ([], "PINHOLE", 0),
        ([0.0] * 5, "PINHOLE", 0),
        ([0.1, 0.0, 0.0, 0.0], "OPENCV", 4),
        ([0.0, 0.0, 0.0, 1e-9, 0.0], "OPENCV", 4),
        ([0.1, 0.2, 0.0, 0.0, 1e-9], "FULL_OPENCV", 8),
        ([0.0] * 7 + [0.3], "FULL_OPENCV", 8),
        ([0.1] * 8 + [0.0] * 6, "FULL_OPENCV", 8),
    ],
)
def test_the_model_is_the_simplest_that_holds_the_lens(distortion: list[float], model: str, count: int) -> None:
    files = write_colmap([replace(CAMERA, distortion=np.array(distortion))])
    ((_, name, *values),) = list_lines(files, "cameras.txt")
    assert name == model
    K = CAMERA.K
    expected = [1280, 720, K[0, 0], K[1, 1], K[0, 2] + 0.5, K[1, 2] + 0.5, *np.resize(distortion, count)[:count]]
    assert [float(value) for value in values][:6] == expected[:6]
    assert [float(value) for value in values][6:] == (distortion + [0.0] * 8)[:count]


@pytest.mark.parametrize("place", [8, 11])
def test_a_lens_beyond_eight_coefficients_is_refused_with_its_camera_and_count(place: int) -> None:
    distortion = np.zeros(12)
    distortion[place] = 0.01
    with pytest.raises(CalibrationError, match=r"^cam1: has 12 coefficients of distortion; .* at most 8\.$"):
        write_colmap([CAMERA, replace(CAMERA, distortion=distortion)])


def test_an_image_is_a_unit_quaternion_from_the_world_and_an_empty_line_of_points() -> None:
    files = write_colmap([replace(CAMERA, id="over the\tdoor"), CAMERA])
    assert files["images.txt"].decode().splitlines()[3::2] == ["", ""]
    first, second = (line for line in list_lines(files, "images.txt") if line)
    assert first[0] == first[8] == "1" and second[0] == second[8] == "2"
    assert first[9:] == ["over_the_door/000000.png"] and second[9:] == ["cam1/000000.png"]
    w, x, y, z = (float(value) for value in first[1:5])
    assert np.allclose(Rotation.from_quat([x, y, z, w]).as_matrix(), CAMERA.T_camera_world[:3, :3], atol=1e-12)
    assert [float(value) for value in first[5:8]] == CAMERA.T_camera_world[:3, 3].tolist()


def test_cameras_turned_by_any_half_turn_come_back() -> None:
    cameras = []
    for axis in np.eye(3):
        T = np.eye(4)
        T[:3, :3] = Rotation.from_rotvec(np.pi * axis).as_matrix()
        cameras.append(replace(CAMERA, id=f"cam{len(cameras)}", T_world_camera=T))
    files = write_colmap(cameras)
    found = parse_colmap(files["cameras.txt"], files["images.txt"], "cameras.txt")
    for camera, other in zip(cameras, found, strict=True):
        assert np.allclose(other.find_pose(1.0), camera.T_world_camera, atol=1e-12)


def test_no_points_are_claimed() -> None:
    assert list_lines(write_colmap([CAMERA]), "points3D.txt") == []

"""OpenCV's file takes any camera: keys that `FileStorage` accepts, real names beside them, all digits."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import film
from tracker.calibration.opencv_file import write_opencv
from tracker.capture.camera import Camera
from tracker.capture.opencv_calibration import find_cameras, parse_opencv

CAMERAS = film(2).cameras


def read_back(cameras: tuple[Camera, ...]):
    return find_cameras(parse_opencv(write_opencv(cameras), "cameras.yaml"), "cameras.yaml", "x")


def open_storage(cameras: tuple[Camera, ...]) -> cv2.FileStorage:
    text = write_opencv(cameras).decode()
    return cv2.FileStorage(text, cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)


@pytest.mark.parametrize("name", ["cam 1", "links: oben", "1", "-", "kamera-ü", "a#b", "'a'", "{a}", "50%", "null"])
def test_a_camera_of_any_name_is_read_by_us_and_by_opencv(name: str) -> None:
    named = (replace(CAMERAS[0], id=name), CAMERAS[1])
    assert [camera.name for camera in read_back(named)] == [name, "cam1"]
    storage = open_storage(named)
    first, second = storage.root().keys()
    assert second == "cam1" and storage.getNode(first).getNode("name").string() == name
    assert np.array_equal(storage.getNode(first).getNode("camera_matrix").mat(), CAMERAS[0].K)


def test_quotes_and_backslashes_which_opencv_does_not_read_become_underlines() -> None:
    assert read_back((replace(CAMERAS[0], id='a\\b"c'), CAMERAS[1]))[0].name == "a_b_c"


def test_names_that_differ_only_in_signs_stay_two_cameras() -> None:
    alike = tuple(replace(camera, id=name) for camera, name in zip(CAMERAS, ("cam-1", "cam 1"), strict=True))
    assert [camera.name for camera in read_back(alike)] == ["cam-1", "cam 1"]
    storage = open_storage(alike)
    first, second = (storage.getNode(f"camera_{n}_cam_1").getNode("camera_matrix").mat() for n in (0, 1))
    assert np.array_equal(first, CAMERAS[0].K) and np.array_equal(second, CAMERAS[1].K)


def test_a_camera_without_distortion_has_five_zeros_and_one_of_eight_coefficients_all_of_them() -> None:
    plain, wide = replace(CAMERAS[0], distortion=np.zeros(0)), replace(CAMERAS[1], distortion=np.arange(8) / 7)
    storage = open_storage((plain, wide))
    first, second = (storage.getNode(key).getNode("distortion_coefficients").mat() for key in ("cam0", "cam1"))
    assert np.array_equal(first, np.zeros((1, 5))) and np.array_equal(second, [np.arange(8) / 7])


def test_the_place_is_world_to_camera_and_no_digit_is_lost() -> None:
    storage = open_storage(CAMERAS)
    node, T = storage.getNode("cam1"), CAMERAS[1].T_camera_world
    assert np.array_equal(node.getNode("R").mat(), T[:3, :3]) and np.array_equal(node.getNode("T").mat(), T[:3, 3:])
    assert np.array_equal(read_back(CAMERAS)[1].K, CAMERAS[1].K)

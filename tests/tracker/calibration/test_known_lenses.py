"""Lenses come from one file or a folder of cameras; what is no possible lens is refused with its file and camera."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import film
from tracker.calibration.anipose_file import write_anipose
from tracker.calibration.colmap_file import write_colmap
from tracker.calibration.known_lenses import load_lenses
from tracker.errors import CalibrationError

CAMERAS = film(2).cameras


def test_a_file_and_the_folder_it_lies_in_hold_the_same_lenses(tmp_path: Path) -> None:
    path = tmp_path / "calibration.toml"
    path.write_bytes(write_anipose(CAMERAS))
    for lenses in (load_lenses(path), load_lenses(tmp_path)):
        assert list(lenses) == ["cam0", "cam1"]
        for camera in CAMERAS:
            assert np.array_equal(lenses[camera.id].K, camera.K) and lenses[camera.id].focal_std == 0.0
            assert np.array_equal(lenses[camera.id].distortion, camera.distortion)


def test_of_a_folder_with_another_calibration_a_file_that_is_named_is_the_only_one_read(tmp_path: Path) -> None:
    for name, cameras in (("old.toml", CAMERAS[:1]), ("new.toml", CAMERAS[1:])):
        (tmp_path / name).write_bytes(write_anipose(cameras))
    assert list(load_lenses(tmp_path / "new.toml")) == ["cam1"]
    with pytest.raises(CalibrationError, match=r"2 calibrations \(new\.toml, old\.toml\); leave one"):
        load_lenses(tmp_path)


def test_a_folder_of_colmaps_text_holds_lenses_by_pixels_from_the_first_ones_centre(tmp_path: Path) -> None:
    for name, data in write_colmap(CAMERAS).items():
        (tmp_path / name).write_bytes(data)
    assert np.allclose(load_lenses(tmp_path)["cam0"].K, CAMERAS[0].K, atol=1e-9)


def test_a_path_without_anything_is_named(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match=r"lenses\.toml: there is no such file of lenses\.$"):
        load_lenses(tmp_path / "lenses.toml")


@pytest.mark.parametrize("name", ["", "notes.md"])
def test_what_holds_no_camera_is_refused_with_the_files_that_do(tmp_path: Path, name: str) -> None:
    (tmp_path / "notes.md").write_text("no lens")
    with pytest.raises(CalibrationError, match=r"holds no camera; needed Anipose's \.toml, OpenCV's \.yaml"):
        load_lenses(tmp_path / name)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"K": np.array([[9.0, 0, 640], [0, 900, 360], [0, 0, 1]])}, r"fx is 9 px for an image of 1280x720"),
        ({"K": np.array([[900.0, 3, 640], [0, 900, 360], [0, 0, 1]])}, r"K has skew 3; calibrate again"),
        ({"distortion": np.full(6, 0.1)}, r"6 distortion coefficients; OpenCV has 0, 4, 5"),
        ({"distortion": np.array([0.1, 1e6, 0, 0, 0])}, r"must be finite and below 10000"),
    ],
)
def test_an_impossible_lens_is_refused_with_its_camera(tmp_path: Path, changes: dict, said: str) -> None:
    path = tmp_path / "calibration.toml"
    path.write_bytes(write_anipose([CAMERAS[0], replace(CAMERAS[1], **changes)]))
    with pytest.raises(CalibrationError, match=rf"cam.?1.*{said}"):
        load_lenses(path)


def test_a_lens_without_a_picture_size_is_judged_by_twice_its_principal_point(tmp_path: Path) -> None:
    path = tmp_path / "calibration.toml"
    text = write_anipose(CAMERAS).decode()
    path.write_text("\n".join(line for line in text.splitlines() if not line.startswith("size")))
    assert np.array_equal(load_lenses(path)["cam1"].K, CAMERAS[1].K)
    far = text.replace(f"[ [ {CAMERAS[0].K[0, 0]}, 0.0,", "[ [ 50.0, 0.0,")
    path.write_text("\n".join(line for line in far.splitlines() if not line.startswith("size")))
    with pytest.raises(CalibrationError, match=r"calibration\.toml: cam0: fx is 50 px for an image of 1294x710"):
        load_lenses(path)

"""The files of a calibration, and what reads them."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, film
from tracker.calibration.anipose_file import write_anipose
from tracker.calibration.calibrate import CalibrationOptions, calibrate_cameras
from tracker.calibration.calibration_output import choose_format, write_calibration
from tracker.calibration.calibration_report import describe_calibration, say_calibration
from tracker.calibration.camera_calibration import CameraCalibration
from tracker.calibration.colmap_file import write_colmap
from tracker.calibration.coverage import draw_coverage
from tracker.calibration.known_lenses import load_lenses
from tracker.calibration.opencv_file import write_opencv
from tracker.capture.anipose_calibration import parse_anipose
from tracker.capture.camera import Camera
from tracker.capture.colmap_calibration import parse_colmap
from tracker.capture.opencv_calibration import find_cameras, parse_opencv
from tracker.capture.video_calibration import VideoCamera
from tracker.errors import CalibrationError

CAMERAS = film(3).cameras


@pytest.fixture(scope="module")
def result() -> CameraCalibration:
    options = CalibrationOptions(max_offset_s=0.2, left_out=0.25)
    return calibrate_cameras(film(2, (0.0, 0.033), seconds=5.0, fps=15.0).sight_all(), BOARD, options)


def check_same(found: list[VideoCamera], cameras: tuple[Camera, ...]) -> None:
    assert [camera.name for camera in found] == [camera.id for camera in cameras]
    for ours, theirs in zip(cameras, found, strict=True):
        assert np.allclose(theirs.K, ours.K, atol=1e-9) and theirs.size == (ours.width, ours.height)
        assert np.allclose(theirs.find_pose(1.0), ours.T_world_camera, atol=1e-9)
        most = max(ours.distortion.size, theirs.distortion.size)
        padded = [np.pad(d, (0, most - d.size)) for d in (ours.distortion, theirs.distortion)]
        assert np.allclose(*padded, atol=1e-12)


def test_aniposes_file_is_read_back_with_its_unit() -> None:
    found = parse_anipose(write_anipose(CAMERAS, (0.0, 0.25, -1.5), 0.3), "calibration.toml")
    check_same(found, CAMERAS)
    assert {camera.unit_m for camera in found} == {1.0}
    strange = (Camera('a "b" \\ ü', 640, 480, np.diag([500.0, 500.0, 1.0])),)
    assert parse_anipose(write_anipose(strange), "x")[0].name == 'a "b" \\ ü'


def test_opencvs_file_is_read_back_by_us_and_by_opencv(tmp_path: Path) -> None:
    path = tmp_path / "cameras.yaml"
    path.write_bytes(write_opencv(CAMERAS))
    check_same(find_cameras(parse_opencv(path.read_bytes(), path.name), path.name, "x"), CAMERAS)
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    node = storage.getNode("cam1")
    assert np.allclose(node.getNode("camera_matrix").mat(), CAMERAS[1].K)
    assert np.allclose(node.getNode("R").mat(), CAMERAS[1].T_camera_world[:3, :3])
    assert int(node.getNode("image_width").real()) == CAMERAS[1].width


def test_colmaps_text_is_read_back_with_pixels_counted_from_the_first_ones_centre() -> None:
    files = write_colmap(CAMERAS)
    words = files["cameras.txt"].decode().splitlines()[1].split()
    assert words[1] == "OPENCV" and float(words[6]) == CAMERAS[0].K[0, 2] + 0.5
    check_same(parse_colmap(files["cameras.txt"], files["images.txt"], "cameras.txt"), CAMERAS)
    full = Camera("a", 640, 480, CAMERAS[0].K, np.array([0.1, 0.2, 0.001, 0.002, 0.3]), CAMERAS[1].T_world_camera)
    files = write_colmap((full,))
    assert b"FULL_OPENCV" in files["cameras.txt"]
    check_same(parse_colmap(files["cameras.txt"], files["images.txt"], "x"), (full,))
    with pytest.raises(CalibrationError, match="a: has 12 coefficients"):
        write_colmap((Camera("a", 640, 480, CAMERAS[0].K, np.full(12, 0.1)),))


def test_everything_is_written_and_names_agree(result: CameraCalibration, tmp_path: Path) -> None:
    for name in ("cameras.toml", "cameras.yaml", "colmap"):
        written = write_calibration(result, tmp_path / name)
        report = Path(written["report"])
        names = {path.name for path in report.iterdir()}
        assert names == {"report.json", "report.txt", "board.toml", "coverage_cam0.png", "coverage_cam1.png"}
        lenses = load_lenses(Path(written["out"]))
        assert list(lenses) == ["cam0", "cam1"] and np.allclose(lenses["cam1"].K, result.cameras[1].K)
    assert not list(tmp_path.rglob("*.tmp"))


def test_the_report_says_the_residuals_of_each_camera_and_board_on_what_was_left_out(result: CameraCalibration) -> None:
    told = json.loads(json.dumps(describe_calibration(result), allow_nan=False))
    for camera in told["cameras"]:
        assert (
            camera["residual_px"]["left_out"]["corners"] > 100 and 0.1 < camera["residual_px"]["left_out"]["rms"] < 0.5
        )
    left_out = [board for board in told["boards"] if board["left_out"]]
    assert left_out and all("cam0" in board["residual_px"] for board in left_out)
    text = say_calibration(result)
    assert "cam1" in text and "left out px" in text and "33." in text


def test_the_picture_shows_where_the_board_was(result: CameraCalibration) -> None:
    image = draw_coverage(result, 0)
    assert image.shape == (540 + 40, 960, 3)
    seen = result.residuals.choose(result.residuals.camera == 0)
    places = np.rint(seen.pixels * 0.75).astype(int)
    assert (image[places[:, 1], places[:, 0]].min(axis=1) < 200).mean() > 0.99
    assert (image[:540] == 232).all(axis=2).any()  # somewhere it was not


@pytest.mark.parametrize("name", ["cameras.txt", "cameras.json", "there"])
def test_a_name_that_asks_for_no_format_is_refused_before_anything_is_done(name: str, tmp_path: Path) -> None:
    (tmp_path / "there").write_text("a file")
    with pytest.raises(CalibrationError, match="--out"):
        choose_format(tmp_path / name)

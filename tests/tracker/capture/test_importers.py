"""Importing real recordings, whole: what comes in is what was there."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.capture import IMPORT_FORMATS, ImportOptions, check_import, load_sequence, run_import
from tracker.capture.importers import list_importers
from tracker.errors import ImportRefusedError

SR300 = ImportOptions(fx=238.95, fy=238.95, cx=160, cy=120, depth_scale=0.001, fps=30)
SR305 = ImportOptions(fx=476.007, cx=313.683, cy=242.755, depth_scale=0.000125, fps=30)


def list_names(folder: Path) -> list[str]:
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


def test_the_formats_are_those_of_the_manual() -> None:
    manual = (Path(__file__).parents[3] / "docs/recordings.md").read_text()
    assert {"recording_folder", "rgbd_folder", "tum_rgbd", "synced_videos"} <= set(IMPORT_FORMATS)
    assert [importer.format for importer in list_importers()][-1] == "rgbd_folder", "which takes any folder of images"
    for name in IMPORT_FORMATS:
        assert f"`{name}`" in manual


@pytest.mark.shared_data
def test_a_real_rgbd_folder_comes_in_bit_by_bit(shared_data: Path, tmp_path: Path) -> None:
    source = shared_data / "uvr_sphere_green"
    stages: list[tuple[str, float]] = []
    report = run_import(
        source, tmp_path / "ball", options=SR300, progress=lambda what, share: stages.append((what, share))
    )
    assert report.ok and report.format == "rgbd_folder" and report.frame_count == 200
    camera = report.cameras[0]
    assert (camera.color_frames, camera.depth_frames, camera.gaps) == (200, 200, ())
    assert camera.depth is not None and camera.depth.percentiles_m[2] == pytest.approx(0.285, abs=0.01)
    sequence = load_sequence(tmp_path / "ball")
    assert (sequence.name, sequence.frame_count, sequence.fps) == ("uvr_sphere_green", 200, 30)
    for index in (0, 99, 199):
        raw = cv2.imread(str(source / f"depth/depth_{index + 31:03d}.png"), cv2.IMREAD_UNCHANGED)
        color = cv2.imread(str(source / f"c2d/c2d_{index + 31:03d}.png"))
        frame = sequence.frame(index, "cam0")
        assert raw is not None and color is not None and frame.depth is not None and frame.color is not None
        np.testing.assert_array_equal(sequence.depth_raw(index, "cam0"), raw)
        np.testing.assert_allclose(frame.depth, raw / 1000, atol=1e-6)
        np.testing.assert_array_equal(frame.color, color[..., ::-1])
    shares = [share for _, share in stages]
    assert shares == sorted(shares) and shares[-1] == 1.0 and len(stages) > 400
    assert [p.name for p in tmp_path.iterdir()] == ["ball"]


@pytest.mark.shared_data
def test_every_stored_image_names_its_original_and_its_hash(shared_data: Path, tmp_path: Path) -> None:
    source = shared_data / "sr305_depth" / "20210326-230536"
    run_import(source, tmp_path / "clip", options=SR305)
    stored = json.loads((tmp_path / "clip/sources.json").read_text())["cameras"]["cam0"]["depth"]
    assert [item["source"] for item in stored] == [f"{n}.png" for n in range(30, 171, 20)]
    for index, item in enumerate(stored):
        assert item["file"] == f"depth/{index:06d}.png"
        original = (source / item["source"]).read_bytes()
        assert (tmp_path / "clip" / item["file"]).read_bytes() == original
        assert item["sha256"] == hashlib.sha256(original).hexdigest()


@pytest.mark.shared_data
def test_a_gap_in_the_numbering_is_refused_until_it_is_allowed(shared_data: Path, tmp_path: Path) -> None:
    source = shared_data / "sr305_depth" / "20210326-231615"
    report = check_import(source, options=SR305)
    assert not report.ok and "1 missing between 100 and 140" in report.problems[0]
    with pytest.raises(ImportRefusedError, match="between 100 and 140"):
        run_import(source, tmp_path / "clip", options=SR305)
    assert list(tmp_path.iterdir()) == []
    allowed = ImportOptions(**SR305.to_json() | {"allow_gaps": True})
    assert run_import(source, tmp_path / "clip", options=allowed).frame_count == 11
    assert load_sequence(tmp_path / "clip").frame_count == 11


@pytest.mark.shared_data
def test_without_options_the_report_says_what_to_give(shared_data: Path) -> None:
    report = check_import(shared_data / "uvr_sphere_green")
    assert not report.ok
    text = " ".join(report.problems)
    assert "give fx, cx, cy" in text and "0.001 puts the scene at 0.285 m" in text
    json.dumps(report.to_json(), allow_nan=False)


@pytest.mark.shared_data
def test_two_clips_in_one_folder_are_not_mixed(shared_data: Path) -> None:
    report = check_import(shared_data / "sr305_depth", options=SR305)
    assert not report.ok and "Choose one with depth_pattern" in report.problems[0]
    chosen = ImportOptions(**SR305.to_json() | {"depth_pattern": "20210326-230536/*.png"})
    assert check_import(shared_data / "sr305_depth", options=chosen).ok


@pytest.mark.shared_data
def test_videos_with_a_calibration_come_in_as_one_world_in_metres(shared_data: Path, tmp_path: Path) -> None:
    source = shared_data / "two_camera_rgb"
    refused = check_import(source)
    assert not refused.ok and "world_unit_m" in refused.problems[0] and refused.baselines_m == {}
    report = run_import(source, tmp_path / "two", options=ImportOptions(world_unit_m=0.04))
    assert report.frame_count == 378 and report.fps == 30
    assert report.cameras[0].timestamps is not None and report.cameras[0].timestamps.dropped == 0
    sequence = load_sequence(tmp_path / "two")
    assert [camera.id for camera in sequence.cameras] == ["cam0", "cam1"]
    numbers = [[float(v) for v in line.split()] for line in (source / "c1.dat").read_text().splitlines()[1:4]]
    np.testing.assert_array_equal(sequence.cameras[1].K, numbers)
    capture = cv2.VideoCapture(str(source / "cam1_test.mp4"))
    for index in range(3):
        _, image = capture.read()
        frame = sequence.frame(index, "cam1")
        assert frame.color is not None
        difference = np.abs(frame.color.astype(int) - image[..., ::-1])
        assert difference.mean() < 2.0  # JPEG of quality 95
    capture.release()


@pytest.mark.shared_data
def test_a_point_in_both_views_agrees_with_opencv_and_with_epipolar_geometry(shared_data: Path, tmp_path: Path) -> None:
    source = shared_data / "two_camera_rgb"
    run_import(source, tmp_path / "two", options=ImportOptions(world_unit_m=0.04))
    cameras = load_sequence(tmp_path / "two").cameras
    rng = np.random.default_rng(0)
    # Points before both cameras: around where their axes come closest.
    centres = np.array([c.T_world_camera[:3, 3] for c in cameras])
    axes = np.array([c.T_world_camera[:3, 2] for c in cameras])
    depths = np.linalg.lstsq(np.stack([axes[0], -axes[1]], axis=1), centres[1] - centres[0], rcond=None)[0]
    assert (depths > 0.1).all()
    points = centres[0] + depths[0] * axes[0] + rng.uniform(-0.05, 0.05, (200, 3))
    pixels = [camera.project(points) for camera in cameras]
    rays = []
    for n, camera in enumerate(cameras):
        rows = [line for line in (source / f"rot_trans_c{n}.dat").read_text().splitlines() if line.strip()]
        R = np.array([[float(v) for v in line.split()] for line in rows[1:4]])
        t = np.array([float(line) for line in rows[5:8]]) * 0.04
        expected = cv2.projectPoints(points, cv2.Rodrigues(R)[0], t, camera.K, camera.distortion)[0][:, 0]
        np.testing.assert_allclose(pixels[n], expected, atol=1e-4)
        rays.append(cv2.undistortPoints(pixels[n][:, None], camera.K, camera.distortion)[:, 0])
    T = cameras[1].T_camera_world @ cameras[0].T_world_camera
    x, y, z = T[:3, 3]
    essential = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ T[:3, :3]
    homogeneous = [np.column_stack([ray, np.ones(len(ray))]) for ray in rays]
    residual = np.einsum("ni,ij,nj->n", homogeneous[1], essential, homogeneous[0])
    assert np.abs(residual).max() < 1e-6
    # The baseline that the file's own second block tells: the translation from camera 0 to camera 1.
    below = (source / "rot_trans_c1.dat").read_text().split("#below")[1].splitlines()
    told = np.array([float(line) for line in below[6:9]]) * 0.04
    assert np.linalg.norm(T[:3, 3]) == pytest.approx(np.linalg.norm(told), rel=0.02)

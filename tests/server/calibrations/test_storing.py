"""A finished calibration lies in files that are the same however often they are written."""

from __future__ import annotations

import io
import json
import uuid
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from server.calibrations.storing import AREA, store_result
from server.storage import Storage
from tests.tracker.calibration.test_camera_faults import calibrated
from tracker.calibration import CameraCalibration, load_lenses
from tracker.capture.colmap_calibration import parse_colmap


@pytest.fixture(scope="module")
def result() -> CameraCalibration:
    return replace(calibrated(), frame_counts=(90, 90), sighting_counts=(80, 70))


def read(storage: Storage, id_: uuid.UUID) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in storage.folder(AREA, id_).iterdir()}


def test_the_cameras_come_back_from_every_format(tmp_path: Path, result: CameraCalibration) -> None:
    storage, id_ = Storage(tmp_path / "data"), uuid.uuid4()
    told = store_result(storage, id_, result)
    files = read(storage, id_)
    formats = {"cameras.toml", "cameras.yaml", "colmap.zip", "report.json", "report.txt", "board.toml"}
    assert set(told["files"]) == formats and set(files) == formats | {"coverage-0.png", "coverage-1.png"}
    for name in ("cameras.toml", "cameras.yaml"):
        lenses = load_lenses(storage.folder(AREA, id_) / name)
        for camera in result.cameras:
            assert np.allclose(lenses[camera.id].K, camera.K, atol=1e-9)
    with zipfile.ZipFile(io.BytesIO(files["colmap.zip"])) as archive:
        found = parse_colmap(archive.read("cameras.txt"), archive.read("images.txt"), "cameras.txt")
    for camera, ours in zip(found, result.cameras, strict=True):
        assert np.allclose(camera.find_pose(1.0), ours.T_world_camera, atol=1e-9)


def test_what_the_row_tells_is_the_report_without_its_boards(tmp_path: Path, result: CameraCalibration) -> None:
    storage, id_ = Storage(tmp_path / "data"), uuid.uuid4()
    told = store_result(storage, id_, result)
    report = json.loads(read(storage, id_)["report.json"])
    assert len(report.pop("boards")) == 3
    assert told.pop("files") and told == report


def test_done_twice_it_writes_the_same_bytes_and_leaves_nothing_beside(
    tmp_path: Path, result: CameraCalibration
) -> None:
    storage, id_ = Storage(tmp_path / "data"), uuid.uuid4()
    first = store_result(storage, id_, result), read(storage, id_)
    (storage.folder(AREA, id_) / "of-a-worker-that-died").write_text("x")
    assert (store_result(storage, id_, result), read(storage, id_)) == first
    assert [path.name for path in (storage.root / AREA).iterdir()] == [str(id_)]


def test_a_lens_that_colmap_cannot_say_leaves_its_archive_out(tmp_path: Path, result: CameraCalibration) -> None:
    storage, id_ = Storage(tmp_path / "data"), uuid.uuid4()
    first, second = result.cameras
    wide = replace(result, cameras=(replace(first, distortion=np.full(12, 0.01)), second))
    assert "colmap.zip" not in store_result(storage, id_, wide)["files"]
    assert "colmap.zip" not in read(storage, id_) and "cameras.toml" in read(storage, id_)


def test_a_result_that_cannot_be_written_leaves_nothing(tmp_path: Path, result: CameraCalibration) -> None:
    storage, id_ = Storage(tmp_path / "data"), uuid.uuid4()
    broken = replace(result, residuals=replace(result.residuals, px=np.array([np.inf, 0.1])))
    with pytest.raises(ValueError, match="JSON"):
        store_result(storage, id_, broken)
    assert not (storage.root / AREA).exists() or list((storage.root / AREA).iterdir()) == []

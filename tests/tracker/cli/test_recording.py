"""Commands on a folder of videos as it is."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.annotations import load_annotations
from tracker.cli.__main__ import main


@pytest.mark.shared_data
def test_hands_are_detected_in_videos_as_they_are(shared_data: Path, tmp_path: Path, capsys) -> None:
    out = tmp_path / "hands.json"
    words = ["detect", str(shared_data / "two_camera_rgb"), "--world-unit-m", "0.04", "--frames", "100:104"]
    assert main([*words, "--out", str(out), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["views"] == ["cam0", "cam1"] and told["frames_with"] == {"right": 4}
    assert [item.frame for item in load_annotations(out).items if item.camera == "cam1"] == [100, 101, 102, 103]


@pytest.mark.slow
@pytest.mark.shared_data
def test_videos_are_tracked_as_they_are(shared_data: Path, tmp_path: Path, capsys) -> None:
    before = sorted((shared_data / "two_camera_rgb").iterdir())
    words = ["track", str(shared_data / "two_camera_rgb"), "--world-unit-m", "0.04", "--hands", "right"]
    assert main([*words, "--frames", "40:46", "--no-calibration", "--out", str(tmp_path / "track"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["frames"] == 6 and told["lost"] == 0
    assert np.load(tmp_path / "track" / "track.npz")["joints_2d"].shape == (6, 2, 21, 2)
    assert sorted((shared_data / "two_camera_rgb").iterdir()) == before


@pytest.mark.shared_data
def test_what_videos_have_to_be_told_is_said_with_exit_code_2(shared_data: Path, tmp_path: Path, capsys) -> None:
    assert main(["track", str(shared_data / "two_camera_rgb"), "--out", str(tmp_path / "track")]) == 2
    assert "Give world_unit_m, metres per unit" in capsys.readouterr().err
    assert not (tmp_path / "track").exists()

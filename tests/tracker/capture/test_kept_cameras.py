"""Cameras that a recording had before."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.kept_cameras import KEPT_FILE, change_cameras, put_cameras_back
from tracker.capture.sequence import SEQUENCE_FILE, load_sequence
from tracker.errors import SequenceError


def move(sequence, metres: float):
    T = np.eye(4)
    T[0, 3] = metres
    return [replace(camera, T_world_camera=T @ camera.T_world_camera) for camera in sequence.cameras]


def test_changes_are_put_back_one_after_the_other_to_the_last_digit(recording: Path) -> None:
    folder = recording
    untouched = load_sequence(folder).to_json()
    change_cameras(load_sequence(folder), move(load_sequence(folder), 0.1), "once")
    once = load_sequence(folder).to_json()
    change_cameras(load_sequence(folder), move(load_sequence(folder), 0.25), "twice")
    assert load_sequence(folder).cameras[0].T_world_camera[0, 3] == pytest.approx(0.35)
    put_cameras_back(load_sequence(folder))
    assert load_sequence(folder).to_json() == once
    put_cameras_back(load_sequence(folder))
    assert load_sequence(folder).to_json() == untouched and not (folder / KEPT_FILE).exists()
    with pytest.raises(SequenceError, match="never changed"):
        put_cameras_back(load_sequence(folder))


def test_a_change_keeps_images_and_everything_else_of_the_recording(recording: Path) -> None:
    folder = recording
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    change_cameras(load_sequence(folder), move(load_sequence(folder), 0.1), "a test")
    for path, content in before.items():
        assert path.name == SEQUENCE_FILE or path.read_bytes() == content


def test_kept_cameras_of_another_recording_are_refused(recording: Path) -> None:
    folder = recording
    change_cameras(load_sequence(folder), move(load_sequence(folder), 0.1), "a test")
    kept = folder / KEPT_FILE
    kept.write_text(kept.read_text().replace('"cam0"', '"cam7"'))
    with pytest.raises(SequenceError, match="copied from elsewhere"):
        put_cameras_back(load_sequence(folder))

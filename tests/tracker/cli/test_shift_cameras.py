"""`handloom shift-cameras`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.calibration.labelled_hands import record_knocked, stand_around
from tests.tracker.calibration.test_hand_offsets import see_hands
from tracker.capture.annotations import load_annotations, save_annotations
from tracker.capture.sequence import load_sequence
from tracker.cli.__main__ import main


@pytest.fixture
def recording(tmp_path: Path, rng: np.random.Generator) -> Path:
    record_knocked(tmp_path / "recording", rng, frames=12)
    return tmp_path / "recording"


def test_a_new_recording_has_the_labels_on_their_pictures(recording: Path, tmp_path: Path, capsys) -> None:
    out = tmp_path / "in_step"
    assert main(["shift-cameras", str(recording), "cam1=+3", "cam2=-1", "--out", str(out), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["frames"] == 8
    new, old = load_sequence(out), load_sequence(recording)
    assert new.name == "knocked in step"
    labels = {item.key: item.points for item in load_annotations(recording / "annotations.json").items}
    for item in load_annotations(out / "annotations.json").items:
        original = item.frame + {"cam1": 4, "cam2": 0}.get(item.camera, 1)
        assert np.array_equal(item.points, labels[original, item.camera, "right"])
        shown, stored = (some.image_path("color", n, item.camera) for some, n in ((new, item.frame), (old, original)))
        assert shown.read_bytes() == stored.read_bytes()


def test_an_offset_is_told_from_detections(recording: Path, capsys, rng: np.random.Generator) -> None:
    sequence = json.loads((recording / "sequence.json").read_text())
    for own, true in zip(sequence["cameras"], stand_around(4), strict=True):
        own["T_world_camera"] = true.T_world_camera.tolist()
    (recording / "sequence.json").write_text(json.dumps(sequence | {"frame_count": 240}))
    assert main(["shift-cameras", str(recording), "--find"]) == 2
    assert "run `handloom detect" in capsys.readouterr().err
    save_annotations(recording / "detections.json", see_hands(stand_around(4), {"cam2": 6.0}, rng))
    assert main(["shift-cameras", str(recording), "--find"]) == 0
    first, second, third = capsys.readouterr().out.splitlines()
    assert "cam1: is in step with cam0" in first and "cam2=+6" in second and "cam3: is in step" in third


def test_what_is_missing_is_said(recording: Path, tmp_path: Path, capsys) -> None:
    assert main(["shift-cameras", str(recording), "cam1=+3"]) == 2
    assert "Needed CAMERA=FRAMES and --out DIR" in capsys.readouterr().err
    assert main(["shift-cameras", str(recording), "cam1=+12", "--out", str(tmp_path / "new")]) == 2
    assert "no moment is left" in capsys.readouterr().err and not (tmp_path / "new").exists()

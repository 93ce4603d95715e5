"""`handloom refine-cameras`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.calibration.labelled_hands import find_farthest_off_px, record_knocked, stand_around
from tracker.capture.sequence import load_sequence
from tracker.cli.__main__ import main


@pytest.fixture
def recording(tmp_path: Path, rng: np.random.Generator) -> Path:
    record_knocked(tmp_path, rng)
    return tmp_path


def test_cameras_are_shown_then_taken_then_put_back(recording: Path, capsys) -> None:
    untouched = (recording / "sequence.json").read_bytes()
    assert main(["refine-cameras", str(recording)]) == 0
    told = capsys.readouterr().out
    assert "Nothing was changed. --take gives" in told and "cam0 stands still" in told
    assert (recording / "sequence.json").read_bytes() == untouched

    assert main(["refine-cameras", str(recording), "--take", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["change"] == "taken" and result["frames_left_out"] == 8
    for camera in result["cameras"]:
        assert camera["left_out_px"]["after"]["rms"] < camera["left_out_px"]["before"]["rms"]
    assert find_farthest_off_px(load_sequence(recording).cameras, stand_around(4)) < 3

    assert main(["refine-cameras", str(recording), "--put-back"]) == 0
    assert (recording / "sequence.json").read_bytes() == untouched


def test_cameras_that_get_no_better_are_not_taken(recording: Path, capsys) -> None:
    assert main(["refine-cameras", str(recording), "--take"]) == 0
    taken = (recording / "sequence.json").read_bytes()
    assert main(["refine-cameras", str(recording), "--take"]) == 2
    assert "The cameras stay as they are." in capsys.readouterr().err
    assert (recording / "sequence.json").read_bytes() == taken


def test_a_recording_without_labels_is_told_what_is_needed(recording: Path, capsys) -> None:
    sequence = json.loads((recording / "sequence.json").read_text())
    del sequence["annotations"]
    (recording / "sequence.json").write_text(json.dumps(sequence))
    assert main(["refine-cameras", str(recording)]) == 2
    assert "needed --annotations FILE" in capsys.readouterr().err

"""`handloom calibrate` asks for what it needs before it fits anything."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.tracker.capture.conftest import write_recording
from tracker.cli.__main__ import main
from tracker.cli.calibrate import show


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Two hands are named."""
    folder = write_recording(tmp_path / "plate", 1)
    document = json.loads((folder / "sequence.json").read_text())
    (folder / "sequence.json").write_text(json.dumps(document | {"hands": ["right", "left"]}))
    return folder


@pytest.mark.parametrize(
    ("out", "hands", "said"),
    [
        ("model.off", ["--hand", "right"], "model.off: needed a file that ends in .npz."),
        ("model", ["--hand", "right"], "needed a file that ends in .npz."),
        ("model.npz", [], "Needed --hand with one of ['right', 'left']."),
        ("model.npz", ["--hand", "trained"], "Needed --hand with one of ['right', 'left']."),
        ("model.npz", ["--hand", "right", "--hand", "left=a.npz"], "--hand left: there are the hands ['right'] only."),
        ("model.npz", ["--hand", "right=nowhere.npz"], "nowhere.npz"),
    ],
)
def test_what_is_missing_is_asked_for_and_no_model_is_written(
    recording: Path, tmp_path: Path, out: str, hands: list[str], said: str, capsys
) -> None:
    assert main(["calibrate", str(recording), "--out", str(tmp_path / out), *hands]) == 2
    assert said in capsys.readouterr().err and not (tmp_path / out).exists()


def test_a_hand_that_the_recording_does_not_show_is_refused_with_the_one_it_does(tmp_path: Path, capsys) -> None:
    folder = write_recording(tmp_path / "plate", 1)
    assert main(["calibrate", str(folder), "--out", str(tmp_path / "a.npz"), "--hand", "left"]) == 2
    assert "Needed --hand with one of ['right']." in capsys.readouterr().err
    assert main(["calibrate", str(tmp_path / "nowhere"), "--out", str(tmp_path / "a.npz")]) == 2
    assert "nowhere" in capsys.readouterr().err


def test_the_model_is_told_with_its_hand() -> None:
    assert show({"hand": "left", "out": "mine.npz"}) == "left hand: mine.npz"

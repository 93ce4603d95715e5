"""`handloom detect`."""

from __future__ import annotations

import json
import os
import shutil
import signal
from pathlib import Path

import pytest

from tests.tracker.cli.test_interrupted import start
from tracker.capture.annotations import load_annotations
from tracker.cli.__main__ import main


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("recordings") / "open"
    assert main(["synthesize", "--motion", "open-close", "--frames", "0:12", "--out", str(out)]) == 0
    return out


def test_the_hands_of_a_recording_are_written_and_counted(recording, tmp_path, capsys):
    out = tmp_path / "new folder" / "hands.json"
    assert main(["detect", str(recording), "--out", str(out), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["frames"] == 12 and told["views"] == ["cam0"] and told["frames_with"] == {"right": 12}
    assert told["median_ms"] > 0 and told["left_out_views"] == []
    assert [item.frame for item in load_annotations(out).items] == list(range(12))
    assert all(0.5 <= item["score"] <= 1.0 for item in json.loads(out.read_text())["items"])
    assert main(["detect", str(recording), "--frames", "3:5", "--view", "cam0", "--out", str(out)]) == 0
    assert "2 frames of 1 view: the right hand in 2" in capsys.readouterr().out
    assert [item.frame for item in load_annotations(out).items] == [3, 4]


def test_the_file_lies_in_the_recording_when_no_other_is_named(recording, tmp_path, capsys):
    copy = tmp_path / "copy"
    shutil.copytree(recording, copy)
    assert main(["detect", str(copy), "--frames", "0:1"]) == 0
    assert (copy / "detections.json").is_file()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--view", "cam9"], "no camera 'cam9'"),
        (["--frames", "40:50"], "none is left of 40:50"),
        (["--out", "FOLDER"], "is a folder"),
        (["--out", "ANNOTATIONS"], "the recording's own annotations"),
    ],
)
def test_what_cannot_be_done_is_said_and_leaves_everything_as_it_was(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    before = (recording / "annotations.json").read_bytes()
    places = {"FOLDER": str(tmp_path), "ANNOTATIONS": str(recording / "annotations.json")}
    assert main(["detect", str(recording), *(places.get(word, word) for word in words)]) == 2
    assert said in capsys.readouterr().err
    assert (recording / "annotations.json").read_bytes() == before
    assert not (recording / "detections.json").exists()


def test_a_damaged_image_and_depth_alone_are_clear_errors(recording, tmp_path, capsys):
    copy = tmp_path / "copy"
    shutil.copytree(recording, copy)
    next((copy / "color").glob("*5.*")).write_bytes(b"no image")
    assert main(["detect", str(copy)]) == 2
    assert "Traceback" not in (said := capsys.readouterr().err) and "5." in said
    document = json.loads((copy / "sequence.json").read_text())
    del document["cameras"][0]["color"]
    (copy / "sequence.json").write_text(json.dumps(document))
    assert main(["detect", str(copy)]) == 2
    assert "only depth images" in capsys.readouterr().err
    assert not (copy / "detections.json").exists()


def test_ctrl_c_leaves_no_file_and_keeps_the_one_of_before(recording, tmp_path):
    out = tmp_path / "hands.json"
    out.write_text("of before")
    process = start("detect", recording, "--out", out)
    assert process.stderr is not None
    process.stderr.readline()  # the first frame is done
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=120)
    assert process.returncode == 130 and said.rstrip().endswith("handloom: stopped") and "Traceback" not in said
    assert out.read_text() == "of before" and os.listdir(tmp_path) == ["hands.json"]

"""The commands, one after the other, as a lab would use them."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

from tracker.cli.__main__ import main


@pytest.fixture(scope="module")
def recording(tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("recordings") / "pinch"
    assert main(["synthesize", "--motion", "pinch", "--frames", "0:12", "--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def tracked(recording, tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("tracks") / "pinch"
    hand = f"right={recording / 'models' / 'right.npz'}"
    assert main(["track", str(recording), "--hand", hand, "--no-calibration", "--out", str(out)]) == 0
    return out


def test_a_synthetic_recording_is_tracked_and_comes_back_within_a_millimetre(recording, tracked, capsys):
    arguments = ["evaluate", str(tracked), "--truth", str(recording / "truth.npz")]
    arguments += ["--annotations", str(recording / "annotations.json"), "--json"]
    assert main(arguments) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["truth"]["frames"] == document["annotations"]["evaluated"] == 12
    assert document["truth"]["joint_error_mm"]["mean"] < 1.0
    assert document["annotations"]["joint_error_px"]["mean"] < 1.0
    assert document["truth"]["lost"] == []


def test_evaluate_says_the_main_figures_in_words(recording, tracked, capsys):
    assert main(["evaluate", str(tracked), "--truth", str(recording / "truth.npz")]) == 0
    said = capsys.readouterr().out
    assert "mm" in said
    assert "lost 0" in said


def test_a_track_folder_holds_what_scripts_rely_on(tracked):
    with np.load(tracked / "track.npz") as track:
        assert track["joints_3d"].shape == (12, 21, 3)
        assert track["joints_2d"].shape == (12, 1, 21, 2)
        assert track["joint_names"][0] == "right/wrist"
        assert set(track["status"]) == {"ok"}
        assert list(track["frame"]) == list(range(12))
    summary = json.loads((tracked / "summary.json").read_text())
    needed = {"frames", "lost", "median_ms", "p95_ms", "stages_ms", "depth_residual_mm", "silhouette_iou", "threads"}
    assert needed <= set(summary)


def test_a_part_of_a_recording_is_tracked_from_its_own_first_frame(recording, tmp_path, capsys):
    hand = f"right={recording / 'models' / 'right.npz'}"
    out = tmp_path / "part"
    arguments = ["track", str(recording), "--hand", hand, "--frames", "5:9", "--no-calibration", "--json"]
    assert main([*arguments, "--out", str(out)]) == 0
    assert json.loads(capsys.readouterr().out)["frames"] == 4
    with np.load(out / "track.npz") as track:
        assert list(track["frame"]) == [5, 6, 7, 8]


def test_a_preset_stands_for_its_options_and_what_is_given_besides_wins(recording, tmp_path):
    hand = f"right={recording / 'models' / 'right.npz'}"
    arguments = ["track", str(recording), "--hand", hand, "--frames", "0:2"]
    for name, given, wanted in (
        ("plain", ["--no-calibration", "--preset", "fast"], ("LO", 5, False, "handloom")),
        ("other", ["--no-calibration", "--preset", "balanced", "--iterations", "7"], ("LO+SC", 7, False, "handloom")),
        ("paper", ["--preset", "t16", "--static-scene", "none"], ("LO+SCP", 10, False, "t16")),
    ):
        assert main([*arguments, *given, "--out", str(tmp_path / name)]) == 0
        options = json.loads((tmp_path / name / "setup.json").read_text())["options"]
        assert tuple(options[key] for key in ("terms", "iterations", "calibrate", "method")) == wanted
        assert options["static_scene"] == ("none" if name == "paper" else "find")
        assert options["use_detector"]


def test_a_run_can_do_without_the_hand_detector(recording, tmp_path):
    hand = f"right={recording / 'models' / 'right.npz'}"
    arguments = ["track", str(recording), "--hand", hand, "--frames", "0:2", "--no-calibration", "--no-detector"]
    assert main([*arguments, "--out", str(tmp_path / "track")]) == 0
    assert not json.loads((tmp_path / "track" / "setup.json").read_text())["options"]["use_detector"]


@pytest.mark.slow
def test_bench_prints_the_time_of_a_frame_and_its_floor_for_every_case(capsys):
    assert main(["bench", "tracking", "--frames", "10", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert list(result) == ["one_hand", "two_hands", "two_hands_object_physics"]
    for found in result.values():
        assert {"median_ms", "floor_ms", "stages_ms"} <= set(found)
        assert 0 < found["floor_ms"] < 10 * found["median_ms"]
        assert found["lost"] == 0
    assert result["two_hands_object_physics"]["floor_stages_ms"]["physics"] > 0
    assert "collision" in result["one_hand"]["floor_stages_ms"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["synthesize", "--motion", "juggle", "--out", "x"], "choose one of open-close, wave, count, pinch"),
        (["synthesize", "--twin", "nowhere", "--out", "x"], "--twin needs --sequence"),
        (["synthesize", "--twin", "nowhere", "--sequence", "09", "--out", "x"], "has no sequence '09'"),
        (["synthesize", "--motion", "wave", "--step", "0", "--out", "x"], "--step must be at least 1"),
        (["synthesize", "--motion", "wave", "--hand", "left=nowhere.npz", "--out", "x"], "nowhere.npz"),
        (["track", "nowhere", "--out", "x"], "nowhere"),
        (["evaluate", "nowhere", "--truth", "truth.npz"], "nowhere"),
        (["evaluate", "nowhere"], "Nothing to compare with"),
        (["bench", "tracking", "--frames", "3"], "at least 10"),
    ],
)
def test_bad_input_is_exit_code_2_and_says_what_to_do(arguments, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert captured.out == ""
    assert list(tmp_path.iterdir()) == []


def test_a_truth_file_that_is_none_is_refused(tracked, tmp_path, capsys):
    path = tmp_path / "truth.npz"
    path.write_bytes(b"not a zip file")
    assert main(["evaluate", str(tracked), "--truth", str(path)]) == 2
    assert "needed a truth file" in capsys.readouterr().err


@pytest.mark.slow
def test_a_hand_is_calibrated_and_the_model_can_be_tracked_with(recording, tmp_path, capsys):
    model = tmp_path / "mine.npz"
    assert main(["calibrate", str(recording), "--out", str(model), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"out": str(model), "hand": "right"}
    out = tmp_path / "track"
    options = ["--no-calibration", "--frames", "0:3", "--terms", "LO+C"]
    assert main(["track", str(recording), "--hand", f"right={model}", *options, "--out", str(out)]) == 0
    assert json.loads((out / "summary.json").read_text())["lost"] == 0


def test_an_object_that_the_recording_does_not_name_is_refused(recording, tmp_path, capsys):
    arguments = ["track", str(recording), "--object", "ball=ball.ply", "--out", str(tmp_path / "track")]
    assert main(arguments) == 2
    assert "names no objects" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["html", "csv", "json"])
def test_evaluate_writes_a_report_that_says_which_labels_it_judged_by(kind, recording, tracked, tmp_path, capsys):
    report = tmp_path / f"report.{kind}"
    labels = recording / "annotations.json"
    arguments = ["evaluate", str(tracked), "--annotations", str(labels), "--json", "--report", str(report)]
    assert main(arguments) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["report"] == str(report)
    text = report.read_text()
    if kind == "csv":
        assert len(text.splitlines()) == 1 + 12 * 21
        return
    assert hashlib.sha256(labels.read_bytes()).hexdigest() in text
    mean = result["annotations"]["joint_error_px"]["mean"]
    if kind == "html":
        assert f"{mean:.2f}" in text
        assert text.count("data:image/jpeg;base64,") == 12, "pictures, for the recording lies beside the annotations"
    else:
        assert json.loads(text)["tracks"][0]["error"]["mean"] == mean


def test_evaluate_leaves_out_what_a_track_made_and_says_so(recording, tracked, tmp_path, capsys):
    document = json.loads((recording / "annotations.json").read_text())
    for item in document["items"][:4]:
        item["sources"] = [{"kind": "track", "label": "Track 2"}] * 21
    labels = tmp_path / "annotations.json"
    labels.write_text(json.dumps(document))
    arguments = ["evaluate", str(tracked), "--annotations", str(labels)]
    assert main(arguments) == 0
    said = capsys.readouterr().out
    assert "against 8 annotated hands" in said and "judged by 168 joints of unknown origin" in said
    assert "84 joints are left out because of their source: 84 accepted from Track 2." in said
    assert main([*arguments, "--sources", "all", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["annotations"]
    assert (found["evaluated"], found["left_out_joints"]) == (12, 0)
    assert main([*arguments, "--sources", "guesses"]) == 2
    assert "'guesses'" in capsys.readouterr().err


def test_a_report_of_another_kind_is_refused_and_nothing_is_written(recording, tracked, tmp_path, capsys):
    arguments = ["evaluate", str(tracked), "--report", str(tmp_path / "report.pdf")]
    assert main([*arguments, "--annotations", str(recording / "annotations.json")]) == 2
    assert "needed one of .html, .csv, .json" in capsys.readouterr().err
    assert main([*arguments, "--truth", str(recording / "truth.npz")]) == 2
    assert "give --annotations" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []

"""Everything that has to be told about a recording is asked at once, with pictures and proposals."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from tracker.capture import ImportOptions, check_import, load_sequence, run_import
from tracker.capture.image_files import ImageFiles
from tracker.capture.import_picture import read_import_picture
from tracker.errors import FrameError


@pytest.fixture
def folder(recording: Path) -> Path:
    """Numbered depth and colour images that nobody says anything about."""
    (recording / "sequence.json").unlink()
    return recording


def required(source: Path, **told: object) -> list[str]:
    report = check_import(source, options=ImportOptions.from_json(told))
    json.dumps(report.to_json(), allow_nan=False)
    assert report.ok == (not [q for q in report.questions if q.is_required] and not report.problems)
    return [question.field for question in report.questions if question.is_required]


def test_two_series_of_depth_and_an_unknown_camera_are_asked_in_one_round(folder: Path, save_png) -> None:
    for number in range(5):
        save_png(folder / f"infrared/{number:06d}.png", np.full((48, 64), 700 + number, np.uint16))
    report = check_import(folder)
    assert required(folder) == ["depth_pattern", "fx", "cx", "cy", "depth_scale"]
    by_field = {question.field: question for question in report.questions}
    depth = by_field["depth_pattern"]
    assert [(c.value, c.count) for c in depth.choices] == [("depth/*.png", 5), ("infrared/*.png", 5)]
    assert depth.choices[1].pictures == ("infrared/000000.png", "infrared/000002.png", "infrared/000004.png")
    assert (depth.proposal, depth.proposed_by) == ("depth/*.png", "its name")
    assert not by_field["fy"].is_required and "As fx" in by_field["fy"].ask
    told = {"depth_pattern": "depth/*.png", "fx": 60, "cx": 31.5, "cy": 23.5, "depth_scale": 0.001}
    assert required(folder, **told) == [], "one round is enough"


def test_colour_of_two_kinds_is_asked_with_depth_alone_among_the_answers(folder: Path) -> None:
    shutil.copytree(folder / "color", folder / "masks")
    (question,) = [q for q in check_import(folder).questions if q.field == "color_pattern"]
    assert [choice.value for choice in question.choices] == ["color/*.png", "masks/*.png", "none"]
    assert required(folder) == ["color_pattern", "fx", "cx", "cy", "depth_scale"]


def test_a_gap_and_a_wrong_pattern_are_asked_with_the_rest(folder: Path) -> None:
    for kind in ("depth", "color"):
        (folder / kind / "000002.png").unlink()
    assert required(folder, depth_pattern="deep/*.png") == [
        *("depth_pattern", "fx", "cx", "cy", "depth_scale", "allow_gaps"),
    ]


def test_a_depth_unit_that_puts_the_hand_nowhere_is_asked_again(folder: Path) -> None:
    told = {"fx": 60, "cx": 31.5, "cy": 23.5}
    for scale in (0.00005, 0.05):
        (question,) = [
            q for q in check_import(folder, options=ImportOptions(**told, depth_scale=scale)).questions if q.is_required
        ]
        assert question.field == "depth_scale"
        assert "Puts the nearest thing at" in question.ask and "needed 0.05 to 5 m" in question.ask
    report = check_import(folder, options=ImportOptions(**told, depth_scale=0.001))
    assert report.ok and report.cameras[0].depth is not None
    assert report.cameras[0].depth.nearest_m == pytest.approx(0.5, abs=0.01)
    assert "cam0: the nearest thing is 0.50 m away." in report.summary


def test_an_impossible_focal_length_is_asked_again(folder: Path) -> None:
    assert required(folder, fx=1.0, cx=31.5, cy=23.5, depth_scale=0.001) == ["fx"]


def test_a_preset_fills_what_was_not_told_and_says_so(folder: Path, tmp_path: Path, save_png) -> None:
    shutil.rmtree(folder / "color")
    for number in range(5):
        save_png(folder / f"depth/{number:06d}.png", np.full((424, 512), 900 + number, np.uint16))
    report = check_import(folder)
    (guess,) = [fit for fit in report.sensors if fit.is_guess]
    assert guess.name == "kinect_v2"
    proposals = {q.field: q.proposal for q in report.questions if q.field in guess.values}
    assert proposals == guess.values, "the guess is proposed, never taken"
    assert not report.ok
    done = run_import(folder, tmp_path / "r", options=ImportOptions(preset="kinect_v2", cx=250.0))
    assert any("typical values of Kinect v2" in text and "cx" not in text.split(" are ")[0] for text in done.warnings)
    camera = load_sequence(tmp_path / "r").cameras[0]
    assert (camera.K[0, 0], camera.K[0, 2], camera.K[1, 2], camera.depth_scale) == (365.456, 250.0, 205.395, 0.001)


def test_a_preset_of_other_images_is_refused_beside_its_field(folder: Path) -> None:
    told = {"fx": 60, "cx": 31.5, "cy": 23.5, "depth_scale": 0.001}
    assert required(folder, **told, preset="kinect_v2") == ["preset"]
    assert required(folder, **told, preset="gameboy") == ["preset"]


@pytest.mark.shared_data
def test_real_recordings_need_one_round(shared_data: Path) -> None:
    cube = check_import(shared_data / "uvr_cube_white")
    (guess,) = [fit for fit in cube.sensors if fit.is_guess]
    assert guess.name == "realsense_sr300" and guess.values["depth_scale"] == 0.001
    assert guess.values["fx"] == pytest.approx(238.95, rel=0.01)
    assert required(shared_data / "uvr_cube_white", **guess.values) == []
    clips = shared_data / "sr305_depth"
    guess = next(fit for fit in check_import(clips).sensors if fit.is_guess)
    assert (guess.name, guess.values["depth_scale"]) == ("realsense_sr300", 0.000125)
    assert required(clips, depth_pattern="20210326-230536/*.png", **guess.values) == []
    assert required(shared_data / "two_camera_rgb") == ["world_unit_m"], "videos need no depth questions"


def test_files_are_looked_at_once_when_what_was_seen_is_kept(folder: Path, monkeypatch) -> None:
    seen: dict = {}
    check_import(folder, probes=seen)
    monkeypatch.setattr(ImageFiles, "probe", lambda *_: pytest.fail("looked again"))
    told = ImportOptions(fx=60, cx=31.5, cy=23.5, depth_scale=0.001)
    assert check_import(folder, options=told, probes=seen).ok


def test_pictures_are_read_by_the_names_of_the_report_and_by_no_others(folder: Path, tmp_path: Path) -> None:
    names = check_import(folder).cameras[0].pictures
    assert names["depth"] == ("depth/000000.png", "depth/000002.png", "depth/000004.png")
    assert read_import_picture(folder, names["depth"][1]).max() == 502
    assert read_import_picture(folder, names["color"][0]).shape == (48, 64, 3)
    (tmp_path / "secret.png").write_bytes((folder / "color/000000.png").read_bytes())
    (folder / "link.png").symlink_to(tmp_path / "secret.png")
    for name in ("../secret.png", "link.png", "/etc/passwd", "depth", "", "x" * 1000):
        with pytest.raises(FrameError):
            read_import_picture(folder, name)


def test_a_set_of_labels_is_told_from_a_recording(tmp_path: Path) -> None:
    for name in ("training_xyz.json", "training_K.json"):
        (tmp_path / name).write_text("[]")
    (problem,) = check_import(tmp_path).problems
    assert "labels in the form of FreiHAND, not a recording" in problem and "page Labels" in problem

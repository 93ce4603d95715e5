"""What a look at a whole folder agrees on: its kind, frames, rate and baselines; and what it cannot."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.capture.conftest import HEIGHT, WIDTH, draw_color, write_png
from tests.tracker.capture.test_film import write_film
from tracker.capture.frame_pattern import parse_pattern
from tracker.capture.import_check import check_import, examine
from tracker.capture.import_options import ImportOptions
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence, save_sequence_json

TOLD = ImportOptions(fx=60, cx=31.5, cy=23.5, depth_scale=0.001, hands=("right",))


def write_cameras(folder: Path, places: dict[str, float]) -> Path:
    """Colour cameras that stand so far along x, m, with two frames each."""
    cameras = []
    for name, x in places.items():
        T = np.eye(4)
        T[0, 3] = x
        K = np.array([[60.0, 0, 31.5], [0, 60.0, 23.5], [0, 0, 1]])
        pattern = parse_pattern(f"{name}/{{:06d}}.png")
        cameras.append(RecordedCamera(name, WIDTH, HEIGHT, K, T_world_camera=T, color=pattern))
        for frame in range(2):
            write_png(folder / name / f"{frame:06d}.png", draw_color(frame))
    save_sequence_json(Sequence(folder, "many", 30.0, 2, tuple(cameras)))
    return folder


def test_every_pair_of_cameras_has_its_baseline_and_an_impossible_one_is_warned_of(tmp_path: Path) -> None:
    report = check_import(write_cameras(tmp_path / "many", {"a": 0.0, "b": 0.004, "c": 0.5, "d": 20.6}))
    assert report.ok and report.baselines_m == {
        "a - b": pytest.approx(0.004),
        "a - c": pytest.approx(0.5),
        "a - d": pytest.approx(20.6),
        "b - c": pytest.approx(0.496),
        "b - d": pytest.approx(20.596),
        "c - d": pytest.approx(20.1),
    }
    assert report.warnings == (
        "a and b are 4.0 mm apart; is the calibration's unit right?",
        "a and d are 20.6 m apart; is the calibration's unit right?",
        "b and d are 20.6 m apart; is the calibration's unit right?",
        "c and d are 20.1 m apart; is the calibration's unit right?",
    )


def test_one_camera_has_no_baseline_and_its_hands_and_rate_are_those_of_the_recording(recording: Path) -> None:
    checked = examine(recording, None, ImportOptions())
    assert checked.report.baselines_m == {} and checked.report.hands == ("right",) and checked.report.fps == 30.0
    assert checked.sizes == {"cam0": (WIDTH, HEIGHT)} and checked.times["cam0"].size == 0
    assert checked.root == recording and checked.plan is not None and checked.plan.fps == 30.0


def test_a_rate_and_hands_that_nobody_tells_are_assumed_and_asked_for(recording: Path) -> None:
    (recording / "sequence.json").unlink()
    report = check_import(recording, options=replace(TOLD, hands=None))
    assert report.ok and report.fps == 30.0 and report.hands == ("right",)
    assert "The frame rate is not known; 30 frames per second are assumed." in report.warnings
    asked = {question.field: question for question in report.questions}
    assert not asked["fps"].is_required and not asked["hands"].is_required
    assert [choice.value for choice in asked["hands"].choices] == [["right"], ["left"], ["right", "left"]]
    told = check_import(recording, options=replace(TOLD, fps=15.0, hands=("left",)))
    assert told.fps == 15.0 and told.hands == ("left",) and told.questions == () and told.warnings == ()


def test_the_rate_of_a_video_is_taken_from_its_header(tmp_path: Path) -> None:
    write_film(tmp_path / "film.avi", 4, "MJPG")
    report = check_import(tmp_path / "film.avi", options=replace(TOLD, depth_scale=None, cx=79.5, cy=59.5, fx=150))
    assert report.ok and report.fps == 30.0 and report.frame_count == 4
    assert report.cameras[0].timestamps is not None and report.cameras[0].timestamps.dropped == 0


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ((), "found no files; needed sequence.json, numbered depth PNGs"),
        (("a.TXT",), r"found 1 file (txt); needed"),
        (("a.txt", "b.csv", "c.csv"), r"found 3 files (csv, txt); needed"),
        (("x_joint_3d.json",), "These 1 files are labels in the form of InterHand2.6M"),
        (("person_keypoints.json", "a.txt"), "These 2 files are labels in the form of COCO"),
    ],
)
def test_a_folder_of_no_known_kind_is_refused_with_what_is_in_it(tmp_path: Path, names: tuple, said: str) -> None:
    for name in names:
        (tmp_path / name).write_text("x")
    report = check_import(tmp_path, options=ImportOptions(name="mine"))
    (problem,) = report.problems
    assert said in problem and not report.ok and report.cameras == ()
    assert report.name == "mine" and report.summary == ("Nothing can be imported.",)
    assert examine(tmp_path, None, ImportOptions()).plan is None


def test_an_unknown_format_is_named_with_the_known_ones_and_kept_in_the_report(recording: Path) -> None:
    report = check_import(recording, "rosbag", ImportOptions(fps=5.0))
    assert report.problems[0].startswith("Format 'rosbag' is not known; known: recording_folder, ")
    assert (report.format, report.options) == ("rosbag", {"fps": 5.0, "format": "rosbag"})


def test_names_that_are_not_safe_are_counted_and_refuse_the_recording(recording: Path, tmp_path: Path) -> None:
    (tmp_path / "outside.txt").write_text("secret")
    (recording / "a.txt").symlink_to(tmp_path / "outside.txt")
    assert check_import(recording).problems == ("1 name in the folder is not safe: a.txt is a link out of the folder.",)
    for number in range(6):
        (recording / f"b{number}.txt").symlink_to(tmp_path / "outside.txt")
    (problem,) = check_import(recording).problems
    assert problem.startswith("7 names in the folder are not safe: a.txt is") and problem.endswith("; and 2 more.")


def test_no_sentence_is_said_twice(recording: Path) -> None:
    for number in (1, 2):
        (recording / f"depth/{number:06d}.png").unlink()
        (recording / f"color/{number:06d}.png").unlink()
    problems = check_import(recording).problems
    assert len(problems) == len(set(problems)) == 2
    assert all("2 of 5 files are missing" in problem for problem in problems)


def test_a_recording_of_more_frames_than_fit_is_refused(recording: Path) -> None:
    document = json.loads((recording / "sequence.json").read_text())
    document["frame_count"] = 10_000_000
    (recording / "sequence.json").write_text(json.dumps(document))
    (problem,) = check_import(recording).problems
    assert "frame_count is 10000000" in problem

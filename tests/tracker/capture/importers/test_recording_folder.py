"""Our own format is imported as `sequence.json` says; what it names and is not there is a problem with its name."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.capture.conftest import write_recording
from tests.tracker.capture.test_film import write_film
from tracker.capture.annotations import Annotation, save_annotations
from tracker.capture.image_files import ImageFiles
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan
from tracker.capture.importers.recording_folder import RecordingFolder, find_model_files
from tracker.capture.listed_files import ListedFiles, list_files
from tracker.capture.video_file import VideoFile


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_recording(tmp_path / "plate", 2)


def change(folder: Path, **values: object) -> None:
    document = json.loads((folder / "sequence.json").read_text())
    (folder / "sequence.json").write_text(json.dumps(document | values))


def plan(folder: Path, **options: object) -> ImportPlan:
    return RecordingFolder().plan(list_files(folder), ImportOptions.from_json(options))


def mark(folder: Path, frame: int, camera: str) -> None:
    change(folder, annotations="marks.json")
    save_annotations(folder / "marks.json", [Annotation(frame, camera, "right", np.full((21, 3), 2.0))])


def test_a_folder_is_recognised_by_its_description_at_the_top(folder: Path) -> None:
    assert RecordingFolder().recognises(list_files(folder))
    assert not RecordingFolder().recognises(ListedFiles(folder, ("deeper/sequence.json", "depth/000000.png")))


def test_the_plan_is_what_the_description_says(folder: Path) -> None:
    made = plan(folder)
    (camera,) = made.cameras
    assert (made.name, made.fps, made.frame_count, made.hands) == ("plate", 30.0, 2, ("right",))
    assert made.problems == made.warnings == made.takes == () and made.unit_known
    assert camera.calibrated_size == (64, 48) and camera.depth_scale == 0.001
    assert camera.color == ImageFiles(folder, ("color/000000.png", "color/000001.png"), False)
    assert camera.depth == ImageFiles(folder, ("depth/000000.png", "depth/000001.png"), True)


def test_what_somebody_says_counts_more_than_the_description(folder: Path) -> None:
    made = plan(folder, name="mine", fps=5.0, hands=["left"])
    assert (made.name, made.fps, made.hands) == ("mine", 5.0, ("left",))


def test_an_object_without_its_model_is_a_problem_and_files_nobody_names_are_left_out(folder: Path) -> None:
    change(folder, objects=[{"name": "ball", "model": "objects/ball.off"}])
    (folder / "notes.txt").write_text("mine")
    made = plan(folder)
    assert made.problems == ("objects/ball.off: the model of object 'ball' is missing.",)
    assert made.warnings == ("1 file that sequence.json does not name is left out: notes.txt.",)


def test_a_film_is_the_colour_of_its_camera_and_a_missing_one_a_problem(folder: Path) -> None:
    document = json.loads((folder / "sequence.json").read_text())
    (camera,) = document["cameras"]
    del camera["color"]
    change(folder, cameras=[camera | {"film": "cam0.avi"}])
    missing = plan(folder)
    assert missing.problems == ("cam0.avi: the film of camera cam0 is missing.",) and missing.cameras[0].color is None
    write_film(folder / "cam0.avi", 2, "MJPG")
    assert plan(folder).cameras[0].color == VideoFile(folder, "cam0.avi")
    assert plan(folder, color_format="png").cameras[0].color == VideoFile(folder, "cam0.avi", lossless=True)
    assert not plan(folder).problems


@pytest.mark.parametrize(("frame", "camera"), [(2, "cam0"), (0, "cam1")])
def test_an_annotation_of_a_picture_that_is_not_there_is_a_problem(folder: Path, frame: int, camera: str) -> None:
    mark(folder, frame, camera)
    made = plan(folder)
    assert made.annotations is None
    assert made.problems == (f"{folder / 'marks.json'}: frame {frame} of camera {camera!r} is not in the recording.",)


def test_annotations_come_along_and_a_damaged_file_of_them_is_a_problem(folder: Path) -> None:
    mark(folder, 1, "cam0")
    made = plan(folder)
    assert made.annotations is not None and [item.frame for item in made.annotations.items] == [1]
    assert made.problems == made.warnings == ()
    (folder / "marks.json").write_text("{")
    assert plan(folder).annotations is None and "marks.json" in plan(folder).problems[0]
    (folder / "marks.json").unlink()
    assert plan(folder).annotations is None and plan(folder).problems == ()


def test_a_model_comes_with_the_files_of_its_name_beside_it_and_no_others() -> None:
    names = ("ball.OFF", "o/ball.OFF", "o/ball.SKEL", "o/ball.x.SKEL", "o/ball2.OFF", "o/p/ball.SKIN")
    files = ListedFiles(Path("/x"), names)
    assert find_model_files(files, "o/ball.OFF") == ["o/ball.OFF", "o/ball.SKEL"]
    assert find_model_files(files, "ball.OFF") == ["ball.OFF"] and find_model_files(files, "cup.obj") == []

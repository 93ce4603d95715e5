"""Cameras shifted by whole frames while they are imported."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.tracker.capture.conftest import HEIGHT, WIDTH, write_png
from tracker.capture.annotations import Annotation, load_annotations, save_annotations
from tracker.capture.frame_pattern import parse_pattern
from tracker.capture.frame_shifts import parse_shifts
from tracker.capture.import_check import check_import
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_run import run_import
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json
from tracker.errors import ImportRefusedError

FRAMES = 10
NUMBERS = {"cam0": 0, "cam1": 100, "cam2": 200}
"""Frame n of a camera is a picture of this plus n."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three cameras with a label on each of their pictures that says which one it is of."""
    place = tmp_path / "apart"
    K = np.array([[60.0, 0, 31.5], [0, 60.0, 23.5], [0, 0, 1]])
    cameras, labels = [], []
    for name, number in NUMBERS.items():
        T = np.eye(4)
        T[0, 3] = number / 1000
        pattern = parse_pattern(f"{name}/{{:06d}}.png")
        cameras.append(RecordedCamera(name, WIDTH, HEIGHT, K, T_world_camera=T, color=pattern))
        for frame in range(FRAMES):
            write_png(place / name / f"{frame:06d}.png", np.full((HEIGHT, WIDTH, 3), number + frame, np.uint8))
            points = np.column_stack([np.full(21, float(number + frame)), np.full(21, 5.0), np.full(21, 2.0)])
            labels.append(Annotation(frame, name, "right", points))
    save_annotations(place / "annotations.json", labels)
    save_sequence_json(Sequence(place, "apart", 30.0, FRAMES, tuple(cameras), annotations="annotations.json"))
    return place


@pytest.mark.parametrize(
    ("shifts", "count", "firsts"),
    [
        ("cam1=+3", 7, {"cam0": 0, "cam1": 3, "cam2": 0}),
        ("cam1=-2", 8, {"cam0": 2, "cam1": 0, "cam2": 2}),
        ("cam1=+3, cam2=-2", 5, {"cam0": 2, "cam1": 5, "cam2": 0}),
        ("cam0=9", 1, {"cam0": 9, "cam1": 0, "cam2": 0}),
    ],
)
def test_every_frame_shows_one_moment_and_every_label_is_on_its_picture(
    folder: Path, tmp_path: Path, shifts: str, count: int, firsts: dict[str, int]
) -> None:
    run_import(folder, tmp_path / "new", options=ImportOptions(camera_shifts=shifts))
    new = load_sequence(tmp_path / "new")
    assert new.frame_count == count and new.annotations_path is not None
    for name, first in firsts.items():
        shown = [int(new.color(frame, name)[0, 0, 0]) for frame in range(count)]
        assert shown == [NUMBERS[name] + first + frame for frame in range(count)]
    labels = load_annotations(new.annotations_path)
    assert len(labels.items) == 3 * count
    for item in labels.items:
        assert item.points[0, 0] == new.color(item.frame, item.camera)[0, 0, 0]


def test_the_old_recording_stays_and_every_frame_tells_its_original(folder: Path, tmp_path: Path) -> None:
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    report = run_import(folder, tmp_path / "new", options=ImportOptions(camera_shifts="cam1=+3"))
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before
    assert '"cam1/000003.png"' in (tmp_path / "new" / "sources.json").read_text()
    assert "Shifted as given: cam1 by +3 frames." in report.warnings
    assert "9 labels are left out, with the pictures that not all cameras have a moment for." in report.warnings


def test_shifting_there_and_back_gives_the_same_pictures_side_by_side(folder: Path, tmp_path: Path) -> None:
    run_import(folder, tmp_path / "there", options=ImportOptions(camera_shifts="cam1=+3"))
    run_import(tmp_path / "there", tmp_path / "back", options=ImportOptions(camera_shifts="cam1=-3"))
    back = load_sequence(tmp_path / "back")
    assert back.frame_count == FRAMES - 6
    for frame in range(back.frame_count):
        assert back.color(frame, "cam1")[0, 0, 0] - back.color(frame, "cam0")[0, 0, 0] == 100


def test_what_is_known_of_other_moments_is_left_out(folder: Path, tmp_path: Path) -> None:
    np.savez(folder / "truth.npz", joints_3d=np.zeros((FRAMES, 21, 3)))
    report = run_import(folder, tmp_path / "new", options=ImportOptions(camera_shifts="cam1=+3"))
    assert not (tmp_path / "new" / "truth.npz").exists()
    assert "truth.npz is left out, because it belongs to the old frames." in report.warnings


@pytest.mark.parametrize(
    ("shifts", "said"),
    [
        ("cam7=+3", "There is no camera 'cam7' to shift; there are cam0, cam1, cam2."),
        ("cam0=2 cam1=2 cam2=2", "All cameras would be shifted alike"),
        ("cam1=+10", "10 frames apart, and the recording has 10: no moment is left"),
    ],
)
def test_a_shift_that_cannot_be_right_is_refused(folder: Path, shifts: str, said: str) -> None:
    report = check_import(folder, options=ImportOptions(camera_shifts=shifts))
    assert not report.ok and said in report.problems[0]


@pytest.mark.parametrize("text", ["cam1", "cam1=", "cam1=1.5", "=3", "cam1=1 cam1=2", "cam1=999999999"])
def test_a_shift_that_cannot_be_read_is_told_what_is_needed(text: str) -> None:
    with pytest.raises(ImportRefusedError, match=r"needed CAMERA=FRAMES"):
        parse_shifts(text)


def film(path: Path, first: int) -> None:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, (64, 48))
    for frame in range(20):
        writer.write(np.full((48, 64, 3), 10 * (first + frame), np.uint8))
    writer.release()


def test_videos_of_a_calibration_that_found_them_out_of_step_are_shifted_when_somebody_says_so(tmp_path: Path) -> None:
    folder = tmp_path / "videos"
    folder.mkdir()
    film(folder / "cam0.avi", 4)
    film(folder / "cam1.avi", 1)  # its frame n + 3 is cam0's frame n
    (folder / "cameras.toml").write_text(
        "".join(
            f'[cam_{n}]\nname = "cam{n}"\nsize = [ 64, 48,]\nmatrix = [ [ 60.0, 0.0, 31.5,], [ 0.0, 60.0, 23.5,], '
            f"[ 0.0, 0.0, 1.0,],]\nrotation = [ 0.0, 0.0, 0.0,]\ntranslation = [ {-n / 10}, 0.0, 0.0,]\n"
            for n in range(2)
        )
        + '[metadata]\nunit = "m"\n[metadata.time_offsets_s]\ncam0 = 0.0\ncam1 = 0.103\n'
    )
    report = check_import(folder)
    (question,) = [question for question in report.questions if question.field == "camera_shifts"]
    assert report.ok and question.proposal == "cam1=+3" and "cam1 by 3.09 frames (103.0 ms)" in question.ask
    run_import(folder, tmp_path / "as_it_is")
    assert load_sequence(tmp_path / "as_it_is").frame_count == 20  # nothing is shifted by itself
    run_import(folder, tmp_path / "shifted", options=ImportOptions(camera_shifts="cam1=+3"))
    shifted = load_sequence(tmp_path / "shifted")
    assert shifted.frame_count == 17
    for frame in range(17):
        assert abs(int(shifted.color(frame, "cam0")[9, 9, 0]) - int(shifted.color(frame, "cam1")[9, 9, 0])) <= 3
    declined = check_import(folder, options=replace(ImportOptions(), camera_shifts="none"))
    assert not any("camera_shifts" in warning for warning in declined.warnings)
    assert [q.field for q in declined.questions if q.field == "camera_shifts"] == [
        "camera_shifts"
    ]  # to change one's mind

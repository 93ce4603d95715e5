"""All that is wrong with films is said at once, and nothing of where the studio keeps them."""

from __future__ import annotations

from pathlib import Path

import pytest

from server.calibrations.checking import check_films
from server.calibrations.schemas import BoardOptions, CalibrationOptions
from tests.server.calibrations.films import write_images


def test_two_folders_of_images_are_two_cameras_that_can_be_calibrated(tmp_path: Path) -> None:
    write_images(tmp_path / "right", 4, size=(40, 30))
    write_images(tmp_path / "left", 4)
    report = check_films(tmp_path, CalibrationOptions(fps=25.0))
    assert report.board.startswith("ChArUco 5x7, squares of 30 mm") and report.lenses == []
    assert [camera.model_dump() for camera in report.cameras] == [
        {"name": name, "kind": "images", "frames": 4, "fps": 25.0, "width": width, "height": height}
        for name, width, height in (("left", 32, 24), ("right", 40, 30))
    ]
    assert report.problems == [] and report.notes == []


@pytest.mark.parametrize(
    ("fps", "find_offsets", "is_noted"), [(None, True, True), (None, False, False), (9.0, True, False)]
)
def test_images_without_a_frame_rate_are_noted_where_offsets_are_looked_for(
    tmp_path: Path, fps: float | None, find_offsets: bool, is_noted: bool
) -> None:
    for name in "abcde":
        write_images(tmp_path / name, 2)
    notes = check_films(tmp_path, CalibrationOptions(fps=fps, find_offsets=find_offsets)).notes
    assert [note.split(":")[0] for note in notes] == ["a, b, c, d"] * is_noted


def test_a_bad_board_bad_lenses_and_a_bad_video_are_said_together_without_the_studios_folder(tmp_path: Path) -> None:
    write_images(tmp_path / "left", 3)
    (tmp_path / "right.avi").write_bytes(b"no video")
    (tmp_path / "lenses").mkdir()
    (tmp_path / "lenses" / "lenses.toml").write_text("[")
    (tmp_path / "empty").mkdir()
    board = BoardOptions(kind="checkerboard", columns=6, rows=8)
    report = check_films(tmp_path, CalibrationOptions(board=board))
    assert report.board == "" and [camera.name for camera in report.cameras] == ["left"]
    for said in ("empty: holds neither images", "looks the same", "The known lenses: ", "right"):
        assert sum(said in problem for problem in report.problems) == 1, (said, report.problems)
    assert not any(str(tmp_path) in problem for problem in report.problems)


def test_no_films_at_all_are_too_few_cameras(tmp_path: Path) -> None:
    report = check_films(tmp_path, CalibrationOptions())
    assert report.cameras == [] and len(report.problems) == 1
    assert "0 cameras" in report.problems[0] and "needed 2 to 16" in report.problems[0]


def test_of_files_that_are_no_films_the_first_five_are_named(tmp_path: Path) -> None:
    for name in "ab":
        write_images(tmp_path / name, 2)
    for number in range(7):
        (tmp_path / f"note{number}.txt").write_text("x")
    [note] = check_films(tmp_path, CalibrationOptions(fps=30.0)).notes
    assert note.endswith(": note0.txt, note1.txt, note2.txt, note3.txt, note4.txt.")

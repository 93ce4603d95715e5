"""`handloom calibrate-cameras`."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import Filmed, film
from tracker.calibration.board_file import write_board
from tracker.capture.anipose_calibration import parse_anipose
from tracker.cli.__main__ import main

OFFSET_S = 0.13
WORD = "charuco:7x5:40:30:5X5_100"


def write_video(path: Path, images: list[np.ndarray], fps: float = 10.0) -> None:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), fps, images[0].shape[::-1])
    for image in images:
        writer.write(cv2.cvtColor(image, cv2.COLOR_GRAY2BGR))
    writer.release()


@pytest.fixture(scope="module")
def filmed() -> Filmed:
    return film(2, (0.0, OFFSET_S), fps=10.0, seconds=8.0, size=(800, 450), spread=0.6)


@pytest.fixture(scope="module")
def videos(filmed: Filmed, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two rendered videos of a waved board, the second one out of step, each frame with a camera's noise."""
    return write_videos(tmp_path_factory.mktemp("filmed"), filmed, 80)


@pytest.fixture(scope="module")
def short_videos(filmed: Filmed, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Their first three seconds, which are enough to say what is wrong with them."""
    return write_videos(tmp_path_factory.mktemp("short"), filmed, 30)


def write_videos(folder: Path, filmed: Filmed, frames: int) -> Path:
    rng = np.random.default_rng(0)
    for number in range(2):
        clean = [filmed.render(number, frame) for frame in range(frames)]
        noisy = [np.clip(image + 2.0 * rng.normal(size=image.shape), 0, 255).astype(np.uint8) for image in clean]
        write_video(folder / f"cam{number}.avi", noisy)
    return folder


@pytest.mark.slow
def test_rendered_videos_are_calibrated_and_the_offset_is_told(
    filmed: Filmed, videos: Path, tmp_path: Path, capsys
) -> None:
    out = tmp_path / "new" / "cameras.toml"
    words = ["calibrate-cameras", str(videos), "--board", WORD, "--out", str(out), "--max-offset", "1", "--json"]
    assert main(words) == 0
    told = json.loads(capsys.readouterr().out)
    second = told["cameras"][1]
    assert abs(second["time_offset"]["seconds"] - OFFSET_S) < 0.002
    assert told["residual_px"]["left_out"]["rms"] < 0.4
    found = parse_anipose(out.read_bytes(), out.name)
    assert [camera.name for camera in found] == ["cam0", "cam1"]
    distance = np.linalg.norm(found[1].find_pose(1.0)[:3, 3])
    assert distance == pytest.approx(np.linalg.norm(filmed.cameras[1].T_world_camera[:3, 3]), rel=0.02)
    assert (Path(told["report"]) / "coverage_cam1.png").stat().st_size > 1000
    lenses = ["--lenses", str(out), "--out", str(tmp_path / "again.yaml")]
    assert main([*words[:4], *lenses, "--max-offset", "1"]) == 0
    assert "cam1: is out of step: it shows a moment 1.3" in capsys.readouterr().out


def test_a_board_is_printed(tmp_path: Path, capsys) -> None:
    out = tmp_path / "board.pdf"
    assert main(["calibrate-cameras", "--board", WORD, "--print-board", str(out)]) == 0
    assert "280 x 200 mm" in capsys.readouterr().out and out.read_bytes().startswith(b"%PDF")
    assert main(["calibrate-cameras", "--board", WORD, "--print-board", str(tmp_path)]) == 2


@pytest.mark.slow
def test_a_mirrored_camera_a_wrong_board_and_an_unreadable_video_are_named(
    short_videos: Path, tmp_path: Path, capsys
) -> None:
    capture = cv2.VideoCapture(str(short_videos / "cam1.avi"))
    images = [capture.read()[1][:, :, 0] for _ in range(30)]
    write_video(tmp_path / "left.avi", [np.ascontiguousarray(image[:, ::-1]) for image in images])
    (tmp_path / "broken.avi").write_bytes((short_videos / "cam0.avi").read_bytes()[:3000])
    (tmp_path / "text.mp4").write_text("no video")
    out = tmp_path / "out" / "cameras.toml"

    def refuse(board: str, *paths: Path) -> str:
        assert main(["calibrate-cameras", *map(str, paths), "--board", board, "--out", str(out)]) == 2
        return capsys.readouterr().err

    assert (
        "left: " in (said := refuse(WORD, tmp_path / "left.avi", short_videos / "cam0.avi")) and "is mirrored" in said
    )
    assert "Markers of DICT_5X5_100 are there" in refuse(
        "charuco:7x5:40:30:6X6_250", short_videos / "cam0.avi", short_videos / "cam1.avi"
    )
    assert "text.mp4: is no MP4" in refuse(WORD, short_videos / "cam0.avi", tmp_path / "text.mp4")
    assert "broken" in refuse(WORD, tmp_path / "broken.avi", short_videos / "cam0.avi")
    assert "1 camera (cam0.avi); needed 2 to 16" in refuse(WORD, short_videos / "cam0.avi")
    assert "17 cameras" in refuse(WORD, *[short_videos / "cam0.avi"] * 17)
    hostile = tmp_path / "board.toml"
    hostile.write_bytes(b"columns = [" * 9000)
    assert "board.toml" in refuse(str(hostile), short_videos / "cam0.avi", short_videos / "cam1.avi")
    assert not out.parent.exists()


def test_folders_of_images_are_one_moment_each_and_a_board_may_come_from_a_file(tmp_path: Path, capsys, filmed) -> None:
    together = film(2, seconds=8.0, fps=10.0, size=(800, 450), spread=0.6)
    for number in range(2):
        folder = tmp_path / "images" / f"view{number}"
        folder.mkdir(parents=True)
        for frame in range(0, 80, 4):
            cv2.imwrite(str(folder / f"{frame:03d}.png"), together.render(number, frame))
    board = tmp_path / "board.toml"
    board.write_bytes(write_board(filmed.board))
    out = tmp_path / "colmap"
    assert main(["calibrate-cameras", str(tmp_path / "images"), "--board", str(board), "--out", str(out)]) == 0
    assert "view1" in capsys.readouterr().out
    assert sorted(path.name for path in out.iterdir()) == ["cameras.txt", "images.txt", "points3D.txt"]


def test_help_does_not_load_numpy() -> None:
    code = (
        "import sys; from tracker.cli.__main__ import main\n"
        "try: main(['calibrate-cameras', '--help'])\n"
        "except SystemExit: pass\n"
        "assert 'numpy' not in sys.modules and 'cv2' not in sys.modules"
    )
    assert b"--print-board" in subprocess.run([sys.executable, "-c", code], check=True, capture_output=True).stdout

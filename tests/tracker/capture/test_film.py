"""Videos as the images of a camera: any frame at any time, exactly, and never more than one of them in memory."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.capture.film import Film
from tracker.capture.video_file import VideoFile
from tracker.errors import FrameError

CODECS = (("MJPG", ".avi"), ("mp4v", ".mp4"), ("XVID", ".avi"), ("mp4v", ".mkv"), ("VP80", ".webm"))


def draw(index: int, size: tuple[int, int]) -> np.ndarray:
    """(H, W, 3) uint8, different for each frame wherever one looks."""
    image = np.full((size[1], size[0], 3), 40, np.uint8)
    image[:, : 20 + (7 * index) % (size[0] - 20)] = (index % 250, 200, 90)
    cv2.putText(image, str(index), (5, size[1] // 2), cv2.FONT_HERSHEY_SIMPLEX, 1.0, (0, 0, 255), 2)
    return image


def write_film(path: Path, frames: int, codec: str = "mp4v", size: tuple[int, int] = (160, 120)) -> VideoFile:
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*codec), 30.0, size)
    assert writer.isOpened(), codec
    for index in range(frames):
        writer.write(draw(index, size))
    writer.release()
    return VideoFile(path.parent, path.name)


def decode_in_order(video: VideoFile) -> list[np.ndarray]:
    return [image[..., ::-1] for _, image in video.images()]


def check_any_order(video: VideoFile, asked: np.ndarray) -> None:
    expected = decode_in_order(video)
    film = Film(video, len(expected))
    for index in asked.tolist():
        np.testing.assert_array_equal(film.frame(index), expected[index], err_msg=f"{video.name}, frame {index}")
    film.close()


@pytest.mark.parametrize(("codec", "suffix"), CODECS)
@pytest.mark.parametrize("seed", [0, 1])
def test_every_frame_asked_in_any_order_is_the_one_decoded_in_order(
    tmp_path: Path, codec: str, suffix: str, seed: int
) -> None:
    video = write_film(tmp_path / f"film{suffix}", 90, codec)
    generator = np.random.default_rng(seed)
    # Every frame, some of them twice, and runs forwards as a tracker asks for them.
    check_any_order(video, np.r_[generator.permutation(90), np.arange(40, 60), generator.integers(90, size=30)])


@pytest.mark.slow
@pytest.mark.shared_data
def test_frames_of_a_recorded_film_are_exact_in_any_order(shared_data: Path) -> None:
    video = VideoFile(shared_data / "two_camera_rgb", "cam0_test.mp4")
    generator = np.random.default_rng(2)
    check_any_order(video, np.r_[generator.permutation(378)[:40], generator.integers(150, 300, size=40)])


@pytest.mark.slow
def test_memory_stays_flat_over_1500_frames(tmp_path: Path) -> None:
    film = Film(write_film(tmp_path / "film.mp4", 1500, size=(640, 480)), 1500)
    held = []
    for index in range(1500):
        assert film.frame(index).shape == (480, 640, 3)
        if index % 100 == 99:
            held.append(resident_megabytes())
    # 1,400 frames are 1,290 MB; a decoder may settle by some.
    assert max(held[1:]) - held[0] < 8.0, held


def resident_megabytes() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def test_threads_that_ask_at_once_each_get_their_own_frame(tmp_path: Path) -> None:
    video = write_film(tmp_path / "film.mp4", 60)
    expected, film = decode_in_order(video), Film(video, 60)
    asked = np.random.default_rng(3).integers(60, size=200).tolist()
    with ThreadPoolExecutor(4) as pool:
        for index, image in zip(asked, pool.map(film.frame, asked), strict=True):
            np.testing.assert_array_equal(image, expected[index])


def test_a_closed_film_opens_again(tmp_path: Path) -> None:
    film = Film(write_film(tmp_path / "film.mp4", 20), 20)
    before = film.frame(13)
    film.close()
    film.close()
    np.testing.assert_array_equal(film.frame(13), before)


def test_a_film_that_is_forgotten_gives_its_file_back(tmp_path: Path) -> None:
    path = tmp_path / "film.mp4"
    film = Film(write_film(path, 20), 20)
    film.frame(3)
    assert is_open(path)
    del film
    assert not is_open(path)


def is_open(path: Path) -> bool:
    files = Path("/proc/self/fd")
    return any(os.path.realpath(entry) == str(path.resolve()) for entry in files.iterdir())


def test_a_film_that_breaks_off_says_after_how_many_frames(tmp_path: Path) -> None:
    video = write_film(tmp_path / "film.avi", 60, "MJPG")
    data = (tmp_path / "film.avi").read_bytes()
    (tmp_path / "film.avi").write_bytes(data[: len(data) // 2])
    film = Film(video, 60)
    assert film.frame(5).shape == (120, 160, 3)
    with pytest.raises(FrameError, match=r"film.avi: ends after [23]\d frames that can be decoded, where 60 should be"):
        film.frame(59)
    assert film.frame(6).shape == (120, 160, 3)  # what is there is still there


def test_a_film_with_a_hole_is_told_by_its_end(tmp_path: Path) -> None:
    video = write_film(tmp_path / "film.avi", 60, "MJPG")
    data = bytearray((tmp_path / "film.avi").read_bytes())
    middle = len(data) // 2
    data[middle : middle + len(data) // 10] = b"Z" * (len(data) // 10)
    (tmp_path / "film.avi").write_bytes(data)
    with pytest.raises(FrameError, match=r"that can be decoded, where 60 should be: .* Copy it again"):
        Film(video, 60).frame(59)


@pytest.mark.parametrize("index", [-1, 20])
def test_frames_that_no_film_has_are_refused(tmp_path: Path, index: int) -> None:
    film = Film(write_film(tmp_path / "film.mp4", 20), 20)
    with pytest.raises(FrameError, match=f"there is no frame {index}; frames go from 0 to 19"):
        film.frame(index)


def test_files_that_are_no_videos_are_refused(tmp_path: Path) -> None:
    (tmp_path / "list.mp4").write_text("#EXTM3U\nhttp://elsewhere/film.mp4\n")
    (tmp_path / "cut.mp4").write_bytes(b"\x00\x00\x00\x20ftypisom" + bytes(100))
    with pytest.raises(FrameError, match=r"list.mp4: is no MP4"):
        Film(VideoFile(tmp_path, "list.mp4"), 5).frame(0)
    with pytest.raises(FrameError, match=r"cut.mp4: cannot be opened"):
        Film(VideoFile(tmp_path, "cut.mp4"), 5).frame(0)
    with pytest.raises(FrameError, match=r"gone.mp4: there is no such file"):
        Film(VideoFile(tmp_path, "gone.mp4"), 5).frame(0)

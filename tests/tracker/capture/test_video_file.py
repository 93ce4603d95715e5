"""Videos from outside: frames as they decode, what a header promises and what is there, and no other kind of file."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.tracker.capture.test_film import draw, write_film
from tracker.capture.image_file import decode_color
from tracker.capture.video_file import VideoFile
from tracker.errors import FrameError

FRAMES = 12


@pytest.fixture
def video(tmp_path: Path) -> VideoFile:
    return write_film(tmp_path / "film.avi", FRAMES, "MJPG")


def cut(video: VideoFile, share: float) -> None:
    path = video.root / video.name
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])


def test_a_sound_video_has_its_frames_size_rate_and_times(video: VideoFile) -> None:
    probe = video.probe(4)
    assert (probe.count, probe.size, probe.fps, probe.problems) == (FRAMES, (160, 120), 30.0, ())
    assert probe.types == {"video frame, stored as JPEG 95": FRAMES} and probe.depth is None
    assert probe.timestamps == pytest.approx(np.arange(FRAMES) / 30, abs=1e-3)
    assert VideoFile(video.root, video.name, lossless=True).probe(4).types == {"video frame, stored as PNG": FRAMES}
    assert video.read_header() == (30.0, FRAMES)


@pytest.mark.parametrize(("codec", "suffix"), [("MJPG", ".avi"), ("mp4v", ".mp4")])
def test_a_look_tells_what_decoding_everything_tells(tmp_path: Path, codec: str, suffix: str) -> None:
    video = write_film(tmp_path / f"film{suffix}", FRAMES, codec)
    looked, probed = video.look(), video.probe(1)
    assert (looked.count, looked.size, looked.fps, looked.problems) == (FRAMES, (160, 120), 30.0, ())
    assert looked.timestamps == pytest.approx(probed.timestamps, abs=1e-6)
    assert looked.types == {"video frame, decoded when asked for": FRAMES}


def test_a_video_of_one_frame_is_a_video(tmp_path: Path) -> None:
    video = write_film(tmp_path / "film.avi", 1, "MJPG")
    assert video.look().count == video.probe(12).count == 1 and len(list(video.read())) == 1


def test_a_video_cut_off_is_refused_with_what_it_promised_and_what_is_there(video: VideoFile) -> None:
    cut(video, 0.6)
    for probe in (video.probe(4), video.look()):
        (problem,) = probe.problems
        assert 0 < probe.count < FRAMES
        assert problem == (
            f"film.avi: promises 12 frames, {probe.count} can be decoded; copy it again, or leave this camera out."
        )


def test_frames_are_read_in_order_lossless_when_asked_for(video: VideoFile) -> None:
    decoded = [image for _, image in video.images()]
    lossless = VideoFile(video.root, video.name, lossless=True)
    for stream in (video, lossless):
        read = list(stream.read())
        assert [image.source for image in read] == [f"film.avi#{index}" for index in range(FRAMES)]
        assert {image.size for image in read} == {(160, 120)} and stream.name_of(3) == read[3].source
        for index, image in enumerate(read):
            pixels = decode_color(image.data, image.source)[..., ::-1]
            off = np.abs(pixels.astype(int) - decoded[index])
            assert off.max() == 0 if stream.lossless else off.mean() < 2
    assert (video.suffix, lossless.suffix) == (".jpg", ".png")


def test_a_frame_is_rgb_and_one_beyond_the_end_is_refused_by_its_number(video: VideoFile) -> None:
    frame = video.read_frame(7)
    assert np.abs(frame[..., ::-1].astype(int) - draw(7, (160, 120))).mean() < 8
    assert frame.flags.c_contiguous
    with pytest.raises(FrameError, match=r"^film\.avi, frame 12: cannot be decoded\.$"):
        video.read_frame(FRAMES)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("gone.mp4", None, r"gone\.mp4: there is no such file"),
        ("list.mp4", b"#EXTM3U\n/etc/passwd\n", r"is no MP4, MOV, AVI, MKV or WebM video \(begins with 23 45 58 54"),
        ("empty.mp4", b"", r"is no MP4.*\(begins with \)"),
        ("sound.avi", b"RIFF\x00\x00\x00\x00WAVEfmt ", r"sound\.avi: is no MP4"),
        ("cut.mp4", b"\x00\x00\x00\x20ftypisom" + bytes(100), r"cut\.mp4: cannot be opened; is it cut off"),
    ],
)
def test_what_is_no_video_is_refused_by_everything_that_opens_it(
    tmp_path: Path, name: str, content: bytes | None, said: str
) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    video = VideoFile(tmp_path, name)
    for read in (lambda: video.probe(3), video.look, video.read_header, lambda: next(video.read())):
        with pytest.raises(FrameError, match=said):
            read()


def test_a_decoder_is_given_back_although_what_it_is_used_for_fails(video: VideoFile) -> None:
    with (
        pytest.raises(FrameError, match=r"film\.avi: found .*needed a video that can be decoded"),
        video.open() as held,
    ):
        raise cv2.error("in the middle")
    assert not held.isOpened()

"""A folder of videos used as it is: the same frames and cameras as its import, and nothing written."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.capture import ImportOptions, load_sequence, run_import, save_sequence_json
from tracker.capture.film_recording import open_recording
from tracker.errors import FrameError, ImportRefusedError, SequenceError, TrackerError

SIZE = (160, 120)
TOLD = ImportOptions(world_unit_m=0.001, hands=("right",), color_format="png")


def write_video(path: Path, frames: int, size: tuple[int, int] = SIZE, fps: float = 30.0) -> None:
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*"MJPG"), fps, size)
    assert writer.isOpened()
    for index in range(frames):
        image = np.full((size[1], size[0], 3), 50, np.uint8)
        image[:, : 30 + index] = (200, 4 * index, len(path.name))
        writer.write(image)
    writer.release()


def write_calibration(folder: Path, **changes: object) -> None:
    lines = []
    for number in (0, 1):
        table: dict[str, object] = {
            "name": f"cam{number}",
            "size": list(SIZE),
            "matrix": [[150.0, 0.0, 79.5], [0.0, 150.0, 59.5], [0.0, 0.0, 1.0]],
            "distortions": [0.01, -0.02, 0.0, 0.0, 0.0],
            "rotation": [0.0, -0.4 * number, 0.0],
            "translation": [-300.0 * number, 0.0, 40.0 * number],
        }
        table |= changes
        lines += [f"[cam_{number}]", *(f"{key} = {json.dumps(value)}" for key, value in table.items())]
    (folder / "calibration.toml").write_text("\n".join(lines))


@pytest.fixture
def films(tmp_path: Path) -> Path:
    folder = tmp_path / "films"
    folder.mkdir()
    for number in (0, 1):
        write_video(folder / f"cam{number}.avi", 30)
    write_calibration(folder)
    return folder


def test_frames_and_cameras_are_those_of_the_import(films: Path, tmp_path: Path) -> None:
    before = sorted(films.iterdir())
    recording = open_recording(films, TOLD)
    run_import(films, tmp_path / "unpacked", options=TOLD)
    unpacked = load_sequence(tmp_path / "unpacked")
    assert (recording.frame_count, recording.fps, recording.hands) == (30, 30.0, ("right",))
    for camera, other in zip(recording.cameras, unpacked.cameras, strict=True):
        assert (camera.id, camera.width, camera.height) == (other.id, other.width, other.height)
        np.testing.assert_array_equal(camera.K, other.K)
        np.testing.assert_array_equal(camera.distortion, other.distortion)
        np.testing.assert_array_equal(camera.T_world_camera, other.T_world_camera)
        assert camera.has_color and not camera.has_depth
        for index in (0, 29, 3, 17):
            np.testing.assert_array_equal(recording.color(index, camera.id), unpacked.color(index, camera.id))
    assert sorted(films.iterdir()) == before


def test_a_recording_of_films_is_saved_read_and_imported(films: Path, tmp_path: Path) -> None:
    recording = open_recording(films, TOLD)
    save_sequence_json(recording)
    stored = open_recording(films)
    assert stored.to_json() == recording.to_json()
    assert stored.cameras[1].film == "cam1.avi"
    np.testing.assert_array_equal(stored.color(11, "cam1"), recording.color(11, "cam1"))
    run_import(films, tmp_path / "unpacked", options=replace(TOLD, world_unit_m=None))
    unpacked = load_sequence(tmp_path / "unpacked")
    assert unpacked.cameras[1].film is None
    np.testing.assert_array_equal(unpacked.color(11, "cam1"), recording.color(11, "cam1"))


def test_one_video_is_a_recording_of_one_camera(films: Path) -> None:
    recording = open_recording(films / "cam0.avi", ImportOptions(fx=150.0, cx=79.5, cy=59.5))
    assert [camera.film for camera in recording.cameras] == ["cam0.avi"]
    assert recording.color(4, recording.cameras[0].id).shape == (120, 160, 3)


def test_a_film_has_no_image_files(films: Path) -> None:
    recording = open_recording(films, TOLD)
    with pytest.raises(FrameError, match="camera cam0 has no files of color images"):
        recording.image_path("color", 0, "cam0")
    with pytest.raises(FrameError, match="no frame 30; frames go from 0 to 29"):
        recording.color(30, "cam0")


def test_videos_of_unequal_length_are_told_apart_and_cut_when_asked(films: Path) -> None:
    write_video(films / "cam1.avi", 22)
    with pytest.raises(ImportRefusedError, match=r"Frame counts differ: cam0 color 30, cam1 color 22\..* allow gaps"):
        open_recording(films, TOLD)
    assert open_recording(films, replace(TOLD, allow_gaps=True)).frame_count == 22


def test_a_camera_that_stops_is_named_before_anything_is_tracked(films: Path) -> None:
    data = (films / "cam1.avi").read_bytes()
    (films / "cam1.avi").write_bytes(data[: len(data) // 2])
    with pytest.raises(ImportRefusedError, match=r"cam1.avi: promises 30 frames, 1\d can be decoded; copy it again"):
        open_recording(films, TOLD)


def test_a_hole_in_a_video_is_told_with_its_camera(films: Path) -> None:
    data = bytearray((films / "cam1.avi").read_bytes())
    middle = len(data) // 2
    data[middle : middle + len(data) // 8] = b"Z" * (len(data) // 8)
    (films / "cam1.avi").write_bytes(data)
    with pytest.raises(TrackerError, match=r"cam1\.avi: (ends after|promises)"):
        read_to_the_end(films)


def leave_out(film: Path, frames: set[int]) -> None:
    """Make frames of an AVI empty, as a grabber does with those that it could not keep."""
    data = film.read_bytes()
    out, at, number = bytearray(data), data.index(b"movi") + 4, 0
    while data[at : at + 4] != b"idx1":
        (size,) = struct.unpack("<I", data[at + 4 : at + 8])
        if data[at : at + 4] == b"00dc" and number in frames:
            out[at + 4 : at + 16] = struct.pack("<I4sI", 0, b"JUNK", size + size % 2 - 8)
        number += data[at : at + 4] == b"00dc"
        at += 8 + size + size % 2
    for number in frames:
        entry = at + 8 + 16 * number
        out[entry + 12 : entry + 16] = bytes(4)
    film.write_bytes(out)


@pytest.mark.parametrize(("frames", "said"), [({12}, "1 frame"), ({5, 6, 7, 20}, "4 frames"), ({28}, "1 frame")])
def test_frames_that_a_camera_left_out_are_told_before_later_ones_are_taken_for_earlier_moments(
    films: Path, tmp_path: Path, frames: set[int], said: str
) -> None:
    leave_out(films / "cam1.avi", frames)
    first = min(frames) - 1
    told = rf"cam1\.avi: promises 30 frames, {30 - len(frames)} .*left out {said}, the first after frame {first} \("
    with pytest.raises(ImportRefusedError, match=told):
        open_recording(films, TOLD)
    with pytest.raises(ImportRefusedError, match=told):
        run_import(films, tmp_path / "unpacked", options=TOLD)
    assert not (tmp_path / "unpacked").exists()


def read_to_the_end(films: Path) -> None:
    recording = open_recording(films, TOLD)
    for index in range(recording.frame_count):
        recording.color(index, "cam1")


def test_videos_without_a_calibration_say_what_to_add(films: Path) -> None:
    (films / "calibration.toml").unlink()
    with pytest.raises(ImportRefusedError, match=r"2 videos and no calibration: add calibration.toml"):
        open_recording(films, TOLD)


def test_an_unknown_unit_is_asked_for(films: Path) -> None:
    with pytest.raises(ImportRefusedError, match=r"unit of the calibration is not known.*Give world_unit_m"):
        open_recording(films)


def test_a_video_of_another_size_than_its_calibration_is_refused(films: Path) -> None:
    write_video(films / "cam0.avi", 30, (192, 160))
    with pytest.raises(ImportRefusedError, match="cam0: is calibrated for 160x120 px; its images are 192x160"):
        open_recording(films, TOLD)


def test_texts_in_the_guise_of_videos_are_refused(films: Path) -> None:
    (films / "cam1.avi").write_text("ffconcat version 1.0\nfile /etc/passwd\n")
    with pytest.raises(TrackerError, match=r"cam1.avi: is no MP4, MOV, AVI, MKV or WebM video"):
        open_recording(films, TOLD)


def test_options_of_videos_are_refused_for_a_recording_folder(films: Path) -> None:
    save_sequence_json(open_recording(films, TOLD))
    with pytest.raises(ImportRefusedError, match=r"holds no videos.*world_unit_m"):
        open_recording(films, TOLD)


@pytest.mark.parametrize(
    ("film", "message"),
    [
        ("../cam0.avi", "film"),
        ("/etc/cam0.avi", "film"),
        ("cam0.txt", "needed a video"),
        (7, "film"),
    ],
)
def test_paths_of_films_are_checked(films: Path, film: object, message: str) -> None:
    document = open_recording(films, TOLD).to_json()
    document["cameras"][0]["film"] = film
    (films / "sequence.json").write_text(json.dumps(document))
    with pytest.raises(SequenceError, match=message):
        load_sequence(films)


def test_a_camera_has_images_or_a_film(films: Path) -> None:
    document = open_recording(films, TOLD).to_json()
    document["cameras"][0]["color"] = "color/{:06d}.png"
    (films / "sequence.json").write_text(json.dumps(document))
    with pytest.raises(SequenceError, match="both 'color' and 'film'"):
        load_sequence(films)


def test_a_film_that_leads_out_of_the_recording_is_refused(films: Path, tmp_path: Path) -> None:
    save_sequence_json(open_recording(films, TOLD))
    (films / "cam0.avi").rename(tmp_path / "elsewhere.avi")
    (films / "cam0.avi").symlink_to(tmp_path / "elsewhere.avi")
    with pytest.raises(FrameError, match="leads out of the recording"):
        load_sequence(films).color(0, "cam0")


def test_a_film_that_is_missing_is_named_by_the_import(films: Path, tmp_path: Path) -> None:
    save_sequence_json(open_recording(films, TOLD))
    (films / "cam1.avi").unlink()
    with pytest.raises(ImportRefusedError, match=r"cam1.avi: the film of camera cam1 is missing"):
        run_import(films, tmp_path / "unpacked")
    with pytest.raises(FrameError, match=r"Camera cam1: cam1.avi: there is no such file"):
        load_sequence(films).color(0, "cam1")


def test_folders_without_videos_are_refused_as_before(tmp_path: Path) -> None:
    with pytest.raises(SequenceError):
        open_recording(tmp_path)
    with pytest.raises(SequenceError, match="is not a folder"):
        open_recording(tmp_path / "nothing")

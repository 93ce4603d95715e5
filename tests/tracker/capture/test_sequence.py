"""A recording folder: what is read, and what is refused and how."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tracker.capture import Sequence, load_sequence, save_sequence_json
from tracker.errors import CalibrationError, FrameError, SequenceError, TrackerError


def change(folder: Path, path: str, value: Any) -> None:
    """Set one value of sequence.json, its place written as `cameras.0.K`."""
    document = json.loads((folder / "sequence.json").read_text())
    node = document
    *parents, last = path.split(".")
    for key in parents:
        node = node[int(key) if key.isdigit() else key]
    node[last] = value
    (folder / "sequence.json").write_text(json.dumps(document))


def test_reads_the_fields_of_a_recording(recording: Path) -> None:
    sequence = load_sequence(recording)
    assert (sequence.name, sequence.fps, sequence.frame_count, sequence.hands) == ("plate", 30.0, 5, ("right",))
    camera = sequence.cameras[0]
    assert (camera.id, camera.width, camera.height, camera.depth_scale) == ("cam0", 64, 48, 0.001)
    np.testing.assert_array_equal(camera.K, [[60, 0, 31.5], [0, 60, 23.5], [0, 0, 1]])
    np.testing.assert_array_equal(camera.T_world_camera, np.eye(4))
    assert camera.has_color and camera.has_depth


def test_a_frame_has_rgb_colour_and_depth_in_metres(recording: Path) -> None:
    frame = load_sequence(recording).frame(3, "cam0")
    assert frame.color is not None and frame.depth is not None
    assert frame.color.dtype == np.uint8 and frame.depth.dtype == np.float32
    np.testing.assert_array_equal(frame.color[20, 7], [200, 7, 3])
    assert frame.depth[20, 20] == pytest.approx(0.503)
    assert frame.depth[0, 0] == 0
    raw = load_sequence(recording).depth_raw(3, "cam0")
    assert raw.dtype == np.uint16 and raw[20, 20] == 503


def test_what_was_saved_is_read_back(recording: Path) -> None:
    before = load_sequence(recording)
    save_sequence_json(before)
    assert load_sequence(recording).to_json() == before.to_json()
    assert sorted(p.name for p in recording.iterdir()) == ["color", "depth", "sequence.json"]


def test_saving_an_impossible_recording_is_refused_and_keeps_the_old_one(recording: Path) -> None:
    before = (recording / "sequence.json").read_bytes()
    good = load_sequence(recording)
    with pytest.raises(SequenceError, match="fps"):
        save_sequence_json(Sequence(recording, good.name, float("nan"), 5, good.cameras))
    assert (recording / "sequence.json").read_bytes() == before


REFUSED: list[tuple[str, Any]] = [
    ("version", 2),
    ("version", True),
    ("name", ""),
    ("name", 7),
    ("name", "a\nb"),
    ("name", "x" * 201),
    ("name", "\ud800"),
    ("fps", 0),
    ("fps", -30),
    ("fps", "30"),
    ("fps", float("nan")),
    ("fps", float("inf")),
    ("fps", 10**400),
    ("frame_count", 0),
    ("frame_count", -1),
    ("frame_count", 2.5),
    ("frame_count", 10**12),
    ("frame_count", True),
    ("cameras", []),
    ("cameras", {}),
    ("cameras", [None]),
    ("hands", ["Right"]),
    ("hands", ["right", "right"]),
    ("hands", "right"),
    ("annotations", "../annotations.json"),
    ("annotations", "/etc/passwd"),
    ("objects", [{"name": "ball", "model": "../../ball.ply"}]),
    ("objects", [{"name": "ball", "model": "C:/ball.ply"}]),
    ("objects", [{"name": "ball", "model": "b.ply", "initial": {"T_world_object": [[1]]}}]),
    ("objects", [{"name": "ball", "model": "b.ply", "initial": {"joints": {"a": [1, 2]}}}]),
    ("cameras.0.id", "../cam0"),
    ("cameras.0.id", "a/b"),
    ("cameras.0.id", ".."),
    ("cameras.0.id", "NUL"),
    ("cameras.0.id", ""),
    ("cameras.0.width", 0),
    ("cameras.0.width", 100_000),
    ("cameras.0.width", 640.0),
    ("cameras.0.height", 2**40),
    ("cameras.0.K", None),
    ("cameras.0.K", [[60, 0, 31.5], [0, 60, 23.5]]),
    ("cameras.0.K", [[0, 0, 31.5], [0, 0, 23.5], [0, 0, 1]]),
    ("cameras.0.K", [[-60, 0, 31.5], [0, 60, 23.5], [0, 0, 1]]),
    ("cameras.0.K", [[60, 0, float("nan")], [0, 60, 23.5], [0, 0, 1]]),
    ("cameras.0.K", [[60, 5, 31.5], [0, 60, 23.5], [0, 0, 1]]),
    ("cameras.0.K", [[60, 0, 31.5], [0, 60, 23.5], [0, 0, 2]]),
    ("cameras.0.K", [[60, 0, 9000], [0, 60, 23.5], [0, 0, 1]]),
    ("cameras.0.K", [[0.06, 0, 31.5], [0, 0.06, 23.5], [0, 0, 1]]),
    ("cameras.0.K", [["60", 0, 31.5], [0, 60, 23.5], [0, 0, 1]]),
    ("cameras.0.distortion", [0.1, 0.2, 0.3]),
    ("cameras.0.distortion", [float("inf"), 0, 0, 0]),
    ("cameras.0.distortion", "none"),
    ("cameras.0.T_world_camera", (2 * np.eye(4)).tolist()),
    ("cameras.0.T_world_camera", np.diag([1.0, 1, -1, 1]).tolist()),
    ("cameras.0.T_world_camera", np.diag([1.0, 1.01, 1, 1]).tolist()),
    ("cameras.0.T_world_camera", np.zeros((4, 4)).tolist()),
    ("cameras.0.T_world_camera", (np.eye(4) + 1e6 * np.eye(4, k=3)).tolist()),
    ("cameras.0.depth_scale", 0),
    ("cameras.0.depth_scale", 1000),
    ("cameras.0.depth_scale", None),
    ("cameras.0.color", "color/frame.png"),
    ("cameras.0.color", "color/{}.png"),
    ("cameras.0.color", "color/{:06d}-{:06d}.png"),
    ("cameras.0.color", "color/{0.__class__}.png"),
    ("cameras.0.color", "color/{:>99999999d}.png"),
    ("cameras.0.color", "color/{:0999999999d}.png"),
    ("cameras.0.color", "color/{:06d!r}.png"),
    ("cameras.0.color", "color/{:06x}.png"),
    ("cameras.0.color", "../color/{:06d}.png"),
    ("cameras.0.color", "color/../../{:06d}.png"),
    ("cameras.0.color", "/color/{:06d}.png"),
    ("cameras.0.color", "\\\\server\\{:06d}.png"),
    ("cameras.0.color", "color\\{:06d}.png"),
    ("cameras.0.color", "color/{:06d}.png\u0000.jpg"),
    ("cameras.0.color", "color/\u202e{:06d}.png"),
    ("cameras.0.color", "color/\uff0e\uff0e/{:06d}.png"),
    ("cameras.0.color", "color/{:06d}.exr"),
    ("cameras.0.color", "color/{:06d}"),
    ("cameras.0.depth", "depth/{:06d}.jpg"),
    ("cameras.0.depth", "color/{:06d}.png"),
]


@pytest.mark.parametrize(("path", "value"), REFUSED, ids=lambda v: re.sub(r"\W+", "_", ascii(v))[:40])
def test_refuses_an_impossible_value_and_names_its_place(recording: Path, path: str, value: Any) -> None:
    change(recording, path, value)
    with pytest.raises((SequenceError, CalibrationError)) as caught:
        load_sequence(recording)
    assert "sequence.json" in str(caught.value)
    if not isinstance(value, float):
        assert path.split(".")[-1].split("_")[0].lower() in str(caught.value).lower() or "JSON" in str(caught.value)


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b"[]", b"null", b"3", b"\xff\xfe", b"[" * 100_000, b'{"version":' + b"9" * 5000 + b"}"],
    ids=["empty", "open", "list", "null", "number", "utf16", "nested", "digits"],
)
def test_refuses_what_is_not_a_recording_document(recording: Path, data: bytes) -> None:
    (recording / "sequence.json").write_bytes(data)
    with pytest.raises(SequenceError):
        load_sequence(recording)


@pytest.mark.parametrize("key", ["version", "name", "fps", "frame_count", "cameras"])
def test_refuses_a_document_without_a_required_field(recording: Path, key: str) -> None:
    document = json.loads((recording / "sequence.json").read_text())
    del document[key]
    (recording / "sequence.json").write_text(json.dumps(document))
    with pytest.raises(SequenceError, match=key):
        load_sequence(recording)


def test_refuses_two_cameras_of_one_name(recording: Path) -> None:
    document = json.loads((recording / "sequence.json").read_text())
    document["cameras"].append(dict(document["cameras"][0], id="CAM0"))
    (recording / "sequence.json").write_text(json.dumps(document))
    with pytest.raises(SequenceError, match="twice"):
        load_sequence(recording)


def test_a_missing_frame_says_which_file(recording: Path) -> None:
    (recording / "depth/000002.png").unlink()
    with pytest.raises(FrameError, match=r"000002\.png: there is no such file"):
        load_sequence(recording).frame(2, "cam0")


@pytest.mark.parametrize("index", [-1, 5, 10**9])
def test_a_frame_that_does_not_exist_is_an_error(recording: Path, index: int) -> None:
    with pytest.raises(FrameError, match="from 0 to 4"):
        load_sequence(recording).frame(index, "cam0")


def test_an_unknown_camera_is_an_error_that_names_the_known(recording: Path) -> None:
    with pytest.raises(SequenceError, match=r"nose.*cam0"):
        load_sequence(recording).frame(0, "nose")


def test_a_frame_cut_off_at_any_byte_is_an_error(recording: Path) -> None:
    path = recording / "depth/000001.png"
    data = path.read_bytes()
    sequence = load_sequence(recording)
    for length in range(len(data)):
        path.write_bytes(data[:length])
        with pytest.raises(FrameError, match=r"000001\.png"):
            sequence.depth_raw(1, "cam0")


def test_a_frame_of_another_size_is_an_error(recording: Path, save_png) -> None:
    save_png(recording / "depth/000001.png", np.ones((48, 60), np.uint16))
    with pytest.raises(FrameError, match=r"60x48 px; camera cam0 is 64x48"):
        load_sequence(recording).frame(1, "cam0")


def test_depth_of_8_bits_is_an_error_that_says_what_to_do(recording: Path, save_png) -> None:
    save_png(recording / "depth/000001.png", np.ones((48, 64), np.uint8))
    with pytest.raises(FrameError, match=r"8-bit grey PNG; needed a 16-bit grey PNG.*export the raw 16-bit depth"):
        load_sequence(recording).frame(1, "cam0")


def test_a_colour_picture_of_depth_is_an_error(recording: Path, save_png) -> None:
    save_png(recording / "depth/000001.png", np.ones((48, 64, 3), np.uint8))
    with pytest.raises(FrameError, match="colour picture"):
        load_sequence(recording).frame(1, "cam0")


def test_a_link_out_of_the_recording_is_not_followed(recording: Path, tmp_path: Path, save_png) -> None:
    secret = save_png(tmp_path / "secret.png", np.full((48, 64), 1000, np.uint16))
    (recording / "depth/000001.png").unlink()
    (recording / "depth/000001.png").symlink_to(secret)
    with pytest.raises(FrameError, match="leads out"):
        load_sequence(recording).frame(1, "cam0")


def test_a_linked_folder_out_of_the_recording_is_not_followed(recording: Path, tmp_path: Path) -> None:
    (recording / "depth").rename(tmp_path / "elsewhere")
    (recording / "depth").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(FrameError, match="leads out"):
        load_sequence(recording).image_path("depth", 0, "cam0")


def test_a_pipe_in_place_of_a_frame_does_not_hang(recording: Path) -> None:
    (recording / "depth/000001.png").unlink()
    os.mkfifo(recording / "depth/000001.png")
    with pytest.raises(FrameError, match="plain file"):
        load_sequence(recording).frame(1, "cam0")


def test_no_folder_and_no_document_are_errors(tmp_path: Path) -> None:
    with pytest.raises(SequenceError, match="not a folder"):
        load_sequence(tmp_path / "nothing")
    with pytest.raises(TrackerError, match="no such file"):
        load_sequence(tmp_path)


def test_objects_are_read_with_where_somebody_placed_them(recording: Path) -> None:
    T = np.eye(4)
    T[:3, 3] = [0.1, 0.2, 0.5]
    item = {
        "name": "rope",
        "model": "objects/rope.OFF",
        "initial": {"T_world_object": T.tolist(), "joints": {"b1": [0, 0, 1]}},
    }
    change(recording, "objects", [item])
    sequence = load_sequence(recording)
    assert sequence.object_path("rope") == recording / "objects/rope.OFF"
    assert sequence.objects[0].T_world_object is not None
    np.testing.assert_array_equal(sequence.objects[0].T_world_object, T)
    np.testing.assert_array_equal(sequence.objects[0].joints["b1"], [0, 0, 1])
    assert sequence.to_json()["objects"] == [json.loads(json.dumps(item))]

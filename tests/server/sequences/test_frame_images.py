"""Images of frames: the stored bytes where a browser shows them right, else made once, and nothing of other files."""

from __future__ import annotations

import uuid
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.errors import NotFoundError
from server.sequences import frame_images
from server.sequences.frame_images import THUMBNAIL_WIDTH, FrameAddress, FrameImages
from server.sequences.models import SequenceRow
from tests.server.conftest import MakeRecording
from tests.server.sequences.stored import Shelf


@pytest.fixture
def images(shelf: Shelf) -> FrameImages:
    return FrameImages(shelf.database, shelf.storage, 10_000_000)


def at(row: SequenceRow, frame: int = 0, camera: str = "cam0") -> FrameAddress:
    return FrameAddress(row.id, row.content_key, camera, frame)


def file_of(shelf: Shelf, row: SequenceRow, name: str) -> Path:
    return shelf.storage.folder("sequences", row.id) / name


def decode(data: bytes) -> np.ndarray:
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)


def test_a_stored_jpeg_is_given_as_it_is_unless_its_exif_could_turn_it(shelf, images, make_recording) -> None:
    row = shelf.put(make_recording(color="jpg"))
    path = file_of(shelf, row, "color/000000.jpg")
    stored = path.read_bytes()
    assert images.color_jpeg(at(row)) == stored
    head, body = stored[:2], stored[2:]
    path.write_bytes(head + b"\xff\xe1\x00\x10Exif\x00\x00MM\x00*\x00\x00\x00\x08" + body)
    given = images.color_jpeg(at(row))
    assert given.startswith(b"\xff\xd8\xff") and b"Exif" not in given
    assert decode(given).shape == (24, 32, 3)


def test_a_png_is_encoded_once_and_looks_as_it_did(shelf, images, make_recording) -> None:
    row = shelf.put(make_recording(size=(64, 48)))
    smooth = np.zeros((48, 64, 3), dtype=np.uint8)
    smooth[..., 2] = np.arange(64) * 3
    path = file_of(shelf, row, "color/000000.png")
    cv2.imwrite(str(path), smooth)
    given = images.color_jpeg(at(row))
    assert np.abs(decode(given).astype(int) - smooth).mean() < 3.0, "red stays red"
    path.unlink()
    assert images.color_jpeg(at(row)) is given


def test_depth_between_near_and_far_is_brighter_the_nearer_and_clear_where_there_is_none(
    shelf, images, make_recording
) -> None:
    row = shelf.put(make_recording(size=(64, 48)))
    raw = np.tile(np.linspace(500, 1000, 64).astype(np.uint16), (48, 1))
    raw[0] = 0
    cv2.imwrite(str(file_of(shelf, row, "depth/000000.png")), raw)
    shown = decode(images.depth_png(at(row), "gray", 0.5, 1.0))
    assert (np.diff(shown[5, :, 0].astype(int)) <= 0).all() and shown[5, 0, 0] > shown[5, -1, 0]
    assert (shown[0, :, 3] == 0).all() and (shown[5, :, 3] == 255).all()
    values, scale = images.depth_raw(at(row))
    np.testing.assert_array_equal(values, raw)
    assert scale == 0.001


def test_near_and_far_of_the_recording_are_taken_where_none_are_given(shelf, images, make_recording) -> None:
    row = shelf.put(make_recording())
    near, far = row.cameras[0]["depth_near"], row.cameras[0]["depth_far"]
    usual = images.depth_png(at(row), "viridis", None, None)
    assert usual == images.depth_png(at(row), "viridis", near, far)
    assert usual != images.depth_png(at(row), "viridis", near, far + 0.5)
    assert images.depth_png(at(row), "gray", 0.9, 0.1) == images.depth_png(at(row), "gray", 0.9, 0.901), (
        "far is never before near"
    )


@pytest.mark.parametrize(("size", "height"), [((64, 48), 180), ((4000, 8), 1), ((24, 96), 960)])
def test_a_thumbnail_has_the_shape_of_its_frame_and_one_width(shelf, images, make_recording, size, height) -> None:
    row = shelf.put(make_recording(size=size))
    assert decode(images.thumbnail_jpeg(at(row))).shape == (height, THUMBNAIL_WIDTH, 3)


def test_a_thumbnail_of_depth_alone_is_black_where_nothing_was_measured(shelf, images, make_recording) -> None:
    row = shelf.put(make_recording(color=None))
    raw = np.zeros((24, 32), dtype=np.uint16)
    raw[:, 16:] = 500
    cv2.imwrite(str(file_of(shelf, row, "depth/000000.png")), raw)
    shown = decode(images.thumbnail_jpeg(at(row)))
    assert shown[:, : THUMBNAIL_WIDTH // 3].max() < 12 and shown[:, -THUMBNAIL_WIDTH // 3 :].max() > 60


@pytest.mark.parametrize(
    ("more", "kind", "told"),
    [
        ({"camera": "cam7"}, "color_jpeg", r"waving has no camera 'cam7'; it has \['cam0'\]"),
        ({"frame": 3}, "color_jpeg", "waving has no frame 3; they go from 0 to 2"),
        ({"frame": -1}, "thumbnail_jpeg", "waving has no frame -1; they go from 0 to 2"),
        ({}, "depth_raw", "The camera 'cam0' of waving has no depth images"),
        ({"content_key": "old"}, "color_jpeg", "has other files than those of the key 'old'"),
        ({"sequence_id": uuid.UUID(int=5)}, "color_jpeg", "does not exist"),
    ],
)
def test_what_is_not_there_is_named_with_what_is(shelf, images, make_recording, more, kind: str, told: str) -> None:
    row = shelf.put(make_recording(depth=False))
    with pytest.raises(NotFoundError, match=told):
        getattr(images, kind)(replace(at(row), **more))


def test_depth_alone_has_no_colour(shelf, images, make_recording: MakeRecording) -> None:
    row = shelf.put(make_recording(color=None))
    with pytest.raises(NotFoundError, match="The camera 'cam0' of waving has no color images"):
        images.color_jpeg(at(row))


def test_a_recording_stays_open_until_others_need_the_room(shelf, images, make_recording, monkeypatch) -> None:
    monkeypatch.setattr(frame_images, "MAX_OPEN", 2)
    rows = [shelf.put(make_recording(f"r{number}")) for number in range(3)]
    first = at(rows[0])
    images.depth_raw(first)
    with shelf.database.writing() as session:
        session.get_one(SequenceRow, rows[0].id).content_key = "another"
    images.depth_raw(first)
    for row in rows[1:]:
        images.depth_raw(at(row))
    with pytest.raises(NotFoundError, match="has other files than those of the key"):
        images.depth_raw(first)

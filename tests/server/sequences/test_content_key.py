"""The content key: another one for other files, the same for the same."""

from __future__ import annotations

import dataclasses

import numpy as np

from server.sequences.content_key import compute_content_key
from tracker import Annotation, load_sequence, save_sequence_json
from tracker.capture.annotations import save_annotations


def test_any_byte_of_an_image_changes_it(make_recording) -> None:
    folder = make_recording()
    before = compute_content_key(load_sequence(folder))
    assert compute_content_key(load_sequence(folder)) == before
    path = folder / "depth" / "000001.png"
    path.write_bytes(path.read_bytes() + b"\0")
    assert compute_content_key(load_sequence(folder)) != before


def test_a_calibration_changes_it(make_recording) -> None:
    recording = load_sequence(make_recording())
    (camera,) = recording.cameras
    moved = dataclasses.replace(camera, depth_scale=0.002)
    assert compute_content_key(dataclasses.replace(recording, cameras=(moved,))) != compute_content_key(recording)


def test_what_people_edit_does_not_change_it(make_recording) -> None:
    folder = make_recording()
    recording = load_sequence(folder)
    before = compute_content_key(recording)
    save_annotations(folder / "annotations.json", [Annotation(0, "cam0", "right", np.ones((21, 3)))])
    edited = dataclasses.replace(recording, name="other", hands=("left",), annotations="annotations.json")
    save_sequence_json(edited)
    assert compute_content_key(load_sequence(folder)) == before

"""FreiHAND: whole right hands in 3D, an image for each sample, and intrinsics that may be others."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from tests.tracker.label_formats.conftest import FRAMES, K, MakeSet, make_sequence
from tests.tracker.label_formats.hands import place_hand
from tracker.capture.annotations import Annotation
from tracker.errors import AnnotationError
from tracker.label_formats.freihand import SAMPLES_FILE, read_freihand, write_freihand
from tracker.label_formats.label_set import ImportedLabels, ImportHints

HAND = place_hand("right", 0)
SAMPLE = {"camera": "cam0", "frame": 2}


def seen(side: str = "right", frame: int = 0, distortion: float = 0.0) -> tuple[Annotation, ...]:
    """A hand as both cameras see it."""
    cameras = make_sequence(2, distortion=distortion).cameras
    world = place_hand(side, frame)
    return tuple(Annotation(frame, c.id, side, np.column_stack([c.project(world), np.full(21, 2.0)])) for c in cameras)


def read(
    make_set: MakeSet, samples: Any = None, count: int = 1, intrinsics: Any = None, **hints: Any
) -> ImportedLabels:
    files = {
        "training_xyz.json": json.dumps([HAND.tolist()] * count).encode(),
        "training_K.json": json.dumps([K.tolist()] * count if intrinsics is None else intrinsics).encode(),
    }
    if samples is not None:
        files[SAMPLES_FILE] = json.dumps(samples).encode()
    return read_freihand(files, [make_set()], ImportHints(**hints))


def test_each_camera_of_a_hand_is_a_sample_in_its_own_frame(make_set: MakeSet) -> None:
    made = write_freihand([make_set(seen())])
    xyz, intrinsics, samples = (
        json.loads(made.files[name]) for name in ("training_xyz.json", "training_K.json", SAMPLES_FILE)
    )
    assert (made.items, made.joints) == (2, 42) and np.array_equal(intrinsics, [K, K])
    for points, sample, camera in zip(xyz, samples, make_sequence(2).cameras, strict=True):
        assert (sample["camera"], sample["frame"], sample["hand"]) == (camera.id, 0, "right")
        T = camera.T_camera_world
        assert np.allclose(points, HAND @ T[:3, :3].T + T[:3, 3], atol=1e-6)
        pixels = np.array(points) @ K.T
        assert np.allclose(pixels[:, :2] / pixels[:, 2:], camera.project(HAND), atol=1e-3)


def test_what_it_cannot_hold_is_counted(make_set: MakeSet) -> None:
    first, second = seen(frame=1)
    second.points[7] = 0.0
    notes = write_freihand([make_set((*seen(), *seen("left", 3), first, second), distortion=0.0)]).notes
    assert "2 left hands were left out: FreiHAND holds right hands only." in notes
    assert "1 right hand was left out: FreiHAND needs all 21 joints in 3D (frame 1)." in notes
    bent = write_freihand([make_set(seen(distortion=-0.1), distortion=-0.1)]).notes
    assert "FreiHAND's projection knows no lens distortion, which 2 samples have." in bent


def test_left_hands_alone_are_refused_with_what_to_do_and_what_was_lost(make_set: MakeSet) -> None:
    with pytest.raises(AnnotationError, match="no right hand of these labels has all 21 joints") as caught:
        write_freihand([make_set(seen("left"))])
    assert caught.value.details[0].startswith("2 left hands were left out")


def test_a_sample_is_of_the_place_that_is_noted_for_it_and_a_known_file_name_counts_more(make_set: MakeSet) -> None:
    found = read(make_set, [SAMPLE])
    assert [item.key for item in found.annotations["a" * 8].items] == [(2, "cam0", "right")]
    assert found.warnings == ("FreiHAND does not say what is occluded; of 1 hand every joint seen is visible.",)
    named = read(make_set, [SAMPLE | {"file_name": "cam0/color/000004.png"}])
    assert [item.frame for item in named.annotations["a" * 8].items] == [4]
    assert named.warnings[0] == (
        "1 sample was taken by file name; its frame number says otherwise (cam0/color/000004.png)."
    )
    unknown = read(make_set, [SAMPLE | {"file_name": "renamed.png"}])
    assert [item.frame for item in unknown.annotations["a" * 8].items] == [2]


@pytest.mark.parametrize("place", [{"camera": "cam7"}, {"frame": FRAMES}])
def test_a_sample_that_is_not_in_the_recording_is_left_out_and_told(place: dict, make_set: MakeSet) -> None:
    found = read(make_set, [SAMPLE | place, SAMPLE], count=2)
    assert len(found.annotations["a" * 8].items) == 1
    assert found.warnings[0].startswith("1 sample is not in the recording and was left out (frame ")


def test_other_intrinsics_than_the_recordings_are_used_and_told_beyond_half_a_pixel(make_set: MakeSet) -> None:
    near, far = (K + np.array([[0.0, 0.0, by], [0.0] * 3, [0.0] * 3]) for by in (0.5, 9.0))
    apart = [read(make_set, [SAMPLE], intrinsics=[own.tolist()]) for own in (K, near, far)]
    base, close, moved = (found.annotations["a" * 8].items[0].points[:, 0] for found in apart)
    assert np.allclose(close - base, 0.5) and np.allclose(moved - base, 9.0)
    assert len(apart[1].warnings) == 1 and "1 sample has other intrinsics than the recording" in apart[2].warnings[0]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"samples": [SAMPLE, SAMPLE]}, f"{SAMPLES_FILE} names 2 samples where there are 1"),
        ({"samples": [SAMPLE], "intrinsics": []}, r"_xyz\.json has 1 samples and \.\.\._K\.json 0; needed as many"),
        ({"samples": [SAMPLE | {"hand": "left"}]}, r"hand .*needed .*right"),
        ({"count": FRAMES}, f"{FRAMES} samples cannot be matched with {FRAMES} frames of 2 cameras: add the file"),
        ({"count": FRAMES, "camera": "cam9"}, "or choose the camera"),
        ({"count": 1, "camera": "cam0"}, f"1 sample cannot be matched with {FRAMES} frames"),
        ({"samples": {}}, "needed a list"),
    ],
)
def test_samples_that_cannot_be_matched_are_refused(arguments: dict, said: str, make_set: MakeSet) -> None:
    with pytest.raises(AnnotationError, match=said):
        read(make_set, **arguments)


def test_one_sample_for_each_frame_of_a_chosen_camera_needs_no_list(make_set: MakeSet) -> None:
    items = read(make_set, count=FRAMES, camera="cam1").annotations["a" * 8].items
    assert [(item.frame, item.camera) for item in items] == [(frame, "cam1") for frame in range(FRAMES)]

"""InterHand2.6M: millimetres, both hands in one list, cameras of its own."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tests.tracker.label_formats.conftest import MakeSet, make_sequence
from tests.tracker.label_formats.hands import place_hand
from tracker.capture.annotations import Annotation
from tracker.errors import AnnotationError
from tracker.label_formats.interhand import PREFIX, read_interhand, write_interhand
from tracker.label_formats.label_set import ImportedLabels, ImportHints

Change = Callable[[dict[str, Any]], None]


def seen(side: str, frame: int, cameras: tuple[str, ...] = ("cam0", "cam1")) -> tuple[Annotation, ...]:
    world = place_hand(side, frame)
    return tuple(
        Annotation(frame, camera.id, side, np.column_stack([camera.project(world), np.full(21, 2.0)]))
        for camera in make_sequence(2).cameras
        if camera.id in cameras
    )


def write(make_set: MakeSet, items: tuple[Annotation, ...]) -> dict[str, Any]:
    files = write_interhand([make_set(items)]).files
    return {what: json.loads(files[f"{PREFIX}_{what}.json"]) for what in ("data", "camera", "joint_3d")}


def read(make_set: MakeSet, documents: dict[str, Any]) -> ImportedLabels:
    files = {f"x_{what}.json": json.dumps(document).encode() for what, document in documents.items()}
    return read_interhand(files, [make_set()], ImportHints())


def test_two_hands_are_interacting_only_where_both_are_marked(make_set: MakeSet) -> None:
    items = (*seen("right", 1), *seen("left", 1, ("cam0",)), *seen("left", 2))
    documents = write(make_set, items)
    world = documents["joint_3d"]["0"]
    assert {frame: entry["hand_type"] for frame, entry in world.items()} == {"1": "right", "2": "left"}, "one view"
    both = write(make_set, (*seen("right", 1), *seen("left", 1)))
    assert both["joint_3d"]["0"]["1"]["hand_type"] == "interacting"
    assert [view["hand_type"] for view in both["data"]["annotations"]] == ["interacting"] * 2
    valid = np.ravel(both["joint_3d"]["0"]["1"]["joint_valid"])
    assert valid.tolist() == [1] * 42


def test_world_and_cameras_are_in_millimetres(make_set: MakeSet) -> None:
    documents = write(make_set, seen("right", 1))
    cameras = documents["camera"]["0"]
    for camera in make_sequence(2).cameras:
        assert np.allclose(cameras["campos"][camera.id], 1000 * camera.T_world_camera[:3, 3])
        assert np.allclose(cameras["camrot"][camera.id], camera.T_camera_world[:3, :3])
    points = np.array(documents["joint_3d"]["0"]["1"]["world_coord"])
    assert np.allclose(points[:21].mean(axis=0), 1000 * place_hand("right", 1).mean(axis=0), atol=1e-2)
    assert not points[21:].any()


@pytest.mark.parametrize(
    ("kind", "sides"), [("right", ["right"]), ("left", ["left"]), ("interacting", ["right", "left"])]
)
def test_the_kind_of_a_view_says_which_hands_are_read_from_it(kind: str, sides: list[str], make_set: MakeSet) -> None:
    documents = write(make_set, (*seen("right", 1), *seen("left", 1)))
    documents["data"]["annotations"][1]["hand_type"] = kind
    found = read(make_set, documents).annotations["a" * 8].items
    assert sorted(item.hand for item in found if item.camera == "cam1") == sorted(sides)
    assert sorted(item.hand for item in found if item.camera == "cam0") == ["left", "right"]


def test_joints_that_are_not_valid_in_a_view_are_absent_in_it_alone(make_set: MakeSet) -> None:
    documents = write(make_set, seen("right", 1))
    documents["data"]["annotations"][0]["joint_valid"][20] = [0]  # the wrist comes last
    first, second = read(make_set, documents).annotations["a" * 8].items
    assert first.points[0].tolist() == [0, 0, 0] and (first.points[1:, 2] == 2).all()
    assert (second.points[:, 2] == 2).all()
    documents["data"]["annotations"][0]["joint_valid"] = [[0]] * 42
    assert [item.camera for item in read(make_set, documents).annotations["a" * 8].items] == ["cam1"]


def test_a_hand_is_seen_by_the_cameras_of_the_file_which_is_told_when_they_are_others(make_set: MakeSet) -> None:
    documents = write(make_set, seen("right", 1))
    plain = read(make_set, documents)
    assert not any("calibration" in warning for warning in plain.warnings)
    documents["camera"]["0"]["princpt"]["cam1"][0] += 10.0
    moved = read(make_set, documents)
    assert "1 camera has another calibration than in the recording; its own was used (cam1)." in moved.warnings
    before, after = (found.annotations["a" * 8].items for found in (plain, moved))
    assert np.allclose(after[1].points[:, 0] - before[1].points[:, 0], 10.0)
    assert np.array_equal(after[0].points, before[0].points)
    documents["camera"]["0"]["princpt"]["cam1"][0] -= 10.0
    documents["camera"]["0"]["campos"]["cam1"][2] += 1.5
    assert any("another calibration" in warning for warning in read(make_set, documents).warnings), "1.5 mm away"


def mirror(documents: dict[str, Any]) -> None:
    documents["camera"]["0"]["camrot"]["cam0"] = np.diag([1.0, 1.0, -1.0]).tolist()


def shear(documents: dict[str, Any]) -> None:
    documents["camera"]["0"]["camrot"]["cam0"][0][1] += 0.1


def lose_frame(documents: dict[str, Any]) -> None:
    del documents["joint_3d"]["0"]["1"]


def lose_camera(documents: dict[str, Any]) -> None:
    del documents["camera"]["0"]["focal"]["cam0"]


def shorten(documents: dict[str, Any]) -> None:
    documents["joint_3d"]["0"]["1"]["world_coord"].pop()


def misname(documents: dict[str, Any]) -> None:
    documents["data"]["annotations"][0]["hand_type"] = "both"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (mirror, r"x_camera\.json.*needed a rotation matrix"),
        (shear, r"x_camera\.json.*needed a rotation matrix"),
        (lose_camera, r"x_camera\.json.*focal"),
        (lose_frame, r"x_joint_3d\.json"),
        (shorten, r"needed 42 x 3 numbers"),
        (misname, r"hand_type.*needed.*right, left"),
    ],
)
def test_what_cannot_be_right_is_refused_in_its_file(change: Change, said: str, make_set: MakeSet) -> None:
    documents = write(make_set, seen("right", 1))
    change(documents)
    with pytest.raises(AnnotationError, match=said):
        read(make_set, documents)


def test_two_files_of_one_kind_are_one_too_many(make_set: MakeSet) -> None:
    files = write_interhand([make_set(seen("right", 1))]).files
    files["other_data.json"] = b"{}"
    with pytest.raises(AnnotationError, match=r"Needed one file \.\.\._data\.json; found 2"):
        read_interhand(files, [make_set()], ImportHints())

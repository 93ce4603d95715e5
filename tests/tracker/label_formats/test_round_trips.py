"""import(export(labels)) is labels, up to what each format says that it loses."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.label_formats.conftest import FRAMES, make_sequence
from tests.tracker.label_formats.hands import drop_outside, flatten, label_sets, place_hand
from tracker.capture.annotations import Annotation, Annotations
from tracker.capture.frame_pattern import parse_pattern
from tracker.errors import AnnotationError
from tracker.label_formats.formats import LABEL_FORMATS, export_labels, import_labels, recognise_labels
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.label_files import pack_files, read_label_files
from tracker.label_formats.label_set import ImportedLabels, LabelSet
from tracker.label_formats.orders import JOINT_ORDERS, find_joint, from_order, to_order
from tracker.model.joints import HAND_JOINTS

Keep = Callable[[np.ndarray], np.ndarray]


def there_and_back(name: str, labels: LabelSet) -> ImportedLabels:
    exported = export_labels(name, [labels])
    assert recognise_labels(exported.files) == name
    found, back = import_labels(None, exported.files, [dataclasses.replace(labels, annotations=Annotations())])
    assert found == name
    assert back.problems == ()
    return back


def assert_same(back: Annotations, wanted: Annotations, keep: Keep, tolerance: float = 0.0) -> None:
    assert [item.key for item in back.items] == [item.key for item in wanted.items]
    for one, other in zip(back.items, wanted.items, strict=True):
        np.testing.assert_allclose(one.points, keep(other.points), rtol=0, atol=tolerance)


@given(label_sets())
@settings(max_examples=25, deadline=None)
def test_our_own_file_keeps_everything(labels: LabelSet) -> None:
    back = there_and_back("annotations", labels)
    assert_same(back.annotations[labels.key], labels.annotations, lambda points: points)


@pytest.mark.parametrize("name", ["coco_keypoints", "coco_wholebody"])
@given(labels=label_sets())
@settings(max_examples=25, deadline=None)
def test_coco_keeps_every_joint_to_the_bit_and_its_occlusion(name: str, labels: LabelSet) -> None:
    back = there_and_back(name, labels)
    assert_same(back.annotations[labels.key], labels.annotations, drop_outside)


@given(label_sets())
@settings(max_examples=25, deadline=None)
def test_deeplabcut_keeps_positions_to_the_bit_and_not_what_is_occluded(labels: LabelSet) -> None:
    back = there_and_back("deeplabcut", labels)
    assert_same(back.annotations[labels.key], labels.annotations, flatten)


@given(label_sets())
@settings(max_examples=25, deadline=None)
def test_the_layout_of_t16_keeps_whole_pixels(labels: LabelSet) -> None:
    back = there_and_back("t16", labels)
    assert_same(back.annotations[labels.key], labels.annotations, lambda points: np.round(flatten(points)))


@pytest.mark.parametrize("name", ["interhand", "freihand"])
@pytest.mark.parametrize("distortion", [0.0, -0.1])
@given(frames=st.sets(st.integers(0, FRAMES - 1), min_size=1))
@settings(max_examples=5, deadline=None)
def test_hands_marked_in_two_views_come_back_by_way_of_3d(name: str, distortion: float, frames: set[int]) -> None:
    sequence = make_sequence(2, distortion=distortion)
    sides = ("right",) if name == "freihand" else ("right", "left")
    items = []
    for frame in frames:
        for side in sides:
            for camera in sequence.cameras:
                marks = np.c_[camera.project(place_hand(side, frame)), np.full(21, 2.0)]
                items.append(Annotation(frame, camera.id, side, marks))
    labels = LabelSet("key", sequence, list_image_names(sequence), Annotations(tuple(items)))
    back = there_and_back(name, labels)
    assert_same(back.annotations["key"], labels.annotations, flatten, tolerance=1e-4)


def test_interhand_leaves_out_joints_that_one_view_alone_marks() -> None:
    sequence = make_sequence(2)
    marks = [np.c_[camera.project(place_hand("left", 0)), np.full(21, 2.0)] for camera in sequence.cameras]
    marks[1][5] = 0
    items = tuple(Annotation(0, f"cam{number}", "left", points) for number, points in enumerate(marks))
    labels = LabelSet("key", sequence, list_image_names(sequence), Annotations(items))
    exported = export_labels("interhand", [labels])
    assert "1 labelled joint has no known position in 3D and was left out." in exported.notes
    back = there_and_back("interhand", labels).annotations["key"]
    assert [item.points[5].tolist() for item in back.items] == [[0, 0, 0], [0, 0, 0]]


def test_a_track_gives_3d_where_one_camera_alone_was_marked_and_says_so() -> None:
    sequence = make_sequence(1)
    world = place_hand("right", 2)
    marks = np.c_[sequence.cameras[0].project(world), np.full(21, 2.0)]
    labels = LabelSet(
        "key", sequence, list_image_names(sequence), Annotations((Annotation(2, "cam0", "right", marks),))
    )
    with pytest.raises(AnnotationError, match="3D joints only"):
        export_labels("freihand", [labels])
    labels = dataclasses.replace(labels, track_joints={(2, "right"): world})
    notes = export_labels("freihand", [labels]).notes
    assert any("21 joints are those of a track, a machine's guess" in note for note in notes)
    assert_same(there_and_back("freihand", labels).annotations["key"], labels.annotations, flatten, tolerance=1e-6)


@pytest.mark.parametrize("name", ["coco_keypoints", "coco_wholebody"])
def test_several_recordings_go_into_one_coco_file_and_come_apart_again(name: str) -> None:
    sets = []
    for key in ("1" * 32, "2" * 32):
        sequence = make_sequence(2)
        item = Annotation(int(key[0]), "cam1", "left", np.full((21, 3), float(key[0])))
        item.points[:, 2] = 2
        sets.append(LabelSet(key, sequence, list_image_names(sequence), Annotations((item,))))
    empty = [dataclasses.replace(item, annotations=Annotations()) for item in sets]
    _, back = import_labels(name, export_labels(name, sets).files, empty)
    assert back.problems == back.warnings == ()
    for item in sets:
        assert_same(back.annotations[item.key], item.annotations, drop_outside)
    with pytest.raises(AnnotationError, match="one recording a file"):
        export_labels("deeplabcut", sets)


@pytest.mark.parametrize("order", JOINT_ORDERS)
def test_every_order_holds_each_joint_once_and_goes_there_and_back(order: str) -> None:
    assert sorted(JOINT_ORDERS[order]) == sorted(HAND_JOINTS)
    values = np.arange(42.0).reshape(21, 2)
    np.testing.assert_array_equal(from_order(to_order(values, order), order), values)


def test_orders_are_those_that_were_published() -> None:
    joints = np.arange(21)[:, None].astype(float)
    assert to_order(joints, "mano")[:, 0].tolist() == [
        *(0, 5, 6, 7, 9, 10, 11, 17, 18, 19, 13, 14, 15, 1, 2, 3),
        *(4, 8, 12, 16, 20),
    ]
    assert to_order(joints, "interhand")[:, 0].tolist() == [
        *(4, 3, 2, 1, 8, 7, 6, 5, 12, 11, 10, 9, 16, 15, 14, 13, 20, 19, 18, 17),
        0,
    ]
    for same in ("openpose", "mediapipe", "coco_wholebody", "freihand"):
        assert to_order(joints, same)[:, 0].tolist() == list(range(21))


def test_names_of_others_are_understood() -> None:
    for name, joint in {
        "INDEX_FINGER_MCP": "index_mcp",
        "PINKY_TIP": "little_tip",
        "forefinger1": "index_mcp",
        "middle_finger4": "middle_tip",
        "THUMB_CMC": "thumb_cmc",
        "r_thumb1": "thumb_cmc",
        "left_ring_finger2": "ring_pip",
        "WRIST": "wrist",
    }.items():
        assert find_joint(name) == HAND_JOINTS.index(joint), name
    for name in ("nose", "thumb", "thumb5", "wrist1", "", "finger", "index_index"):
        assert find_joint(name) is None, name


@given(label_sets())
@settings(max_examples=5, deadline=None)
def test_the_same_labels_give_the_same_bytes(labels: LabelSet) -> None:
    for name in ("annotations", "coco_keypoints", "coco_wholebody", "deeplabcut", "t16"):
        one, other = (pack_files(export_labels(name, [labels]).files) for _ in range(2))
        assert one == other


def test_a_zip_of_an_export_is_read_again(tmp_path, make_set) -> None:  # type: ignore[no-untyped-def]
    points = np.c_[np.full((21, 2), 50.0), np.full(21, 2.0)]
    labels = make_set((Annotation(1, "cam1", "left", points),))
    for name in set(LABEL_FORMATS) - {"freihand", "interhand"}:
        exported = export_labels(name, [labels])
        (tmp_path / f"{name}.zip").write_bytes(pack_files(exported.files))
        assert read_label_files(tmp_path / f"{name}.zip") == exported.files


def test_depth_under_visible_joints_gives_3d_in_one_camera(tmp_path: Path) -> None:
    (tmp_path / "depth").mkdir()
    depth = np.full((480, 640), 600, np.uint16)
    depth[:, 400:] = 0
    cv2.imwrite(str(tmp_path / "depth" / "000000.png"), depth)
    camera = dataclasses.replace(make_sequence(1).cameras[0], depth=parse_pattern("depth/{:06d}.png"))
    sequence = dataclasses.replace(make_sequence(1), folder=tmp_path, cameras=(camera,))
    marks = np.c_[np.linspace(100, 420, 21), np.linspace(50, 200, 21), np.full(21, 2.0)]
    marks[3, 2] = 1
    labels = LabelSet("key", sequence, list_image_names(sequence), Annotations((Annotation(0, "cam0", "left", marks),)))
    exported = export_labels("interhand", [labels])
    assert "18 joints are on the skin, where the depth was read; the joint itself lies deeper." in exported.notes
    assert "3 labelled joints have no known position in 3D and were left out." in exported.notes
    world = json.loads(exported.files["InterHand2.6M_train_joint_3d.json"])["0"]["0"]
    coords, valid = np.array(world["world_coord"]), np.ravel(world["joint_valid"]).astype(bool)
    np.testing.assert_allclose(coords[valid, 2], 600.0)
    (item,) = there_and_back("interhand", labels).annotations["key"].items
    kept = item.points[:, 2] > 0
    assert np.flatnonzero(~kept).tolist() == [3, 19, 20]
    np.testing.assert_allclose(item.points[kept], marks[kept], atol=1e-9)

"""COCO keypoints: boxes around whole pixels, categories that are hands, joints by their names."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from tests.tracker.label_formats.conftest import MakeSet
from tests.tracker.label_formats.hands import points
from tracker.capture.annotations import Annotation
from tracker.capture.joint_source import JointSource
from tracker.errors import AnnotationError
from tracker.label_formats.coco_keypoints import describe_box, read_coco_keypoints, write_coco_keypoints, write_points
from tracker.label_formats.label_set import ImportedLabels, ImportHints
from tracker.model.joints import HAND_JOINTS

MARKS = np.column_stack([np.arange(21) * 10.0, np.arange(21) * 5.0 + 20, np.tile([2.0, 1.0, 2.0], 7)])
LEFT = {"id": 2, "name": "left_hand", "keypoints": list(HAND_JOINTS)}


def document(**changes: Any) -> dict[str, Any]:
    image = {"id": 5, "file_name": "cam0/color/000001.png"}
    annotation = {"id": 1, "image_id": 5, "category_id": 2, "keypoints": MARKS.ravel().tolist()}
    return {"images": [image], "annotations": [annotation], "categories": [LEFT]} | changes


def read(make_set: MakeSet, hints: ImportHints = ImportHints(), **changes: Any) -> ImportedLabels:
    return read_coco_keypoints({"a.json": json.dumps(document(**changes)).encode()}, [make_set()], hints)


def only(found: ImportedLabels) -> Annotation:
    (item,) = found.annotations["a" * 8].items
    return item


@given(points())
@settings(max_examples=30)
def test_a_box_holds_every_joint_that_is_there_with_its_whole_pixel(marks: np.ndarray) -> None:
    box = describe_box(marks)
    x, y, width, height = box["bbox"]
    there = marks[marks[:, 2] > 0, :2]
    assert np.allclose([x, y], there.min(axis=0)) and np.allclose([x + width, y + height], there.max(axis=0) + 1)
    assert box["area"] == pytest.approx(width * height) and min(width, height) >= 1 - 1e-9


def test_a_hand_without_joints_has_an_empty_box_and_zeros() -> None:
    assert describe_box(np.zeros((21, 3))) == {"bbox": [0.0, 0.0, 0.0, 0.0], "area": 0.0}
    outside = np.tile([-1.0, -1.0, 0.0], (2, 1))
    assert write_points(np.vstack([outside, [7.5, 8.0, 1.0]])) == [0, 0, 0, 0, 0, 0, 7.5, 8.0, 1]


def test_ids_are_whole_numbers_from_one_and_each_image_is_there_once(make_set: MakeSet) -> None:
    items = tuple(Annotation(frame, "cam1", hand, MARKS) for frame in (3, 0) for hand in ("right", "left"))
    written = json.loads(write_coco_keypoints([make_set(items)]).files["coco_keypoints.json"])
    assert [annotation["id"] for annotation in written["annotations"]] == [1, 2, 3, 4]
    assert [(image["id"], image["frame"]) for image in written["images"]] == [(1, 0), (2, 3)]
    assert {a["category_id"] for a in written["annotations"]} == {1, 2}
    assert all(annotation["num_keypoints"] == 21 for annotation in written["annotations"])


def test_where_a_joint_came_from_follows_it_into_another_order(make_set: MakeSet) -> None:
    order = [(5 * place + 3) % 21 for place in range(21)]
    mixed = LEFT | {"keypoints": [HAND_JOINTS[joint] for joint in order]}
    sources = [{"kind": "track", "label": f"Track {joint}"} for joint in order]
    annotation = document()["annotations"][0] | {"keypoints": MARKS[order].ravel().tolist(), "joint_sources": sources}
    item = only(read(make_set, categories=[mixed], annotations=[annotation]))
    assert np.array_equal(item.points, MARKS)
    assert item.sources == tuple(JointSource("track", f"Track {joint}") for joint in range(21))


@pytest.mark.parametrize(
    ("name", "hint", "side"),
    [
        *(("Right Hand", None, "right"), ("left-hand", "right", "left"), ("lefthand", None, "left")),
        *(("hand", "left", "left"), ("my hands", "right", "right"), ("bright hand", "left", "left")),
    ],
)
def test_a_side_is_in_the_categorys_name_or_told(name: str, hint: str | None, side: str, make_set: MakeSet) -> None:
    assert only(read(make_set, ImportHints(hand=hint), categories=[LEFT | {"name": name}])).hand == side


def test_what_is_no_hand_is_left_out_with_a_count(make_set: MakeSet) -> None:
    others = [{"id": 7, "name": "handbag"}, {"id": 8, "name": "person", "keypoints": ["nose", "left_eye"]}]
    extra = [document()["annotations"][0] | {"category_id": id_} for id_ in (7, 8)]
    found = read(make_set, categories=[*others, LEFT], annotations=[*document()["annotations"], *extra])
    assert only(found).hand == "left"
    assert found.warnings == ("2 annotations of categories that are no hands were left out.",)
    with pytest.raises(AnnotationError, match=r"a\.json: no category is a hand with 21 named keypoints"):
        read(make_set, categories=others)


@pytest.mark.parametrize(
    ("annotation", "said"),
    [
        ({"image_id": 6}, r"annotations\[0\]\.image_id is 6; needed the id of one of the images"),
        ({"keypoints": [1.0, 2.0, 3.0] * 21}, r"needed visibilities 0 \(absent\), 1 \(occluded\) or 2 \(visible\)"),
        ({"keypoints": [0] * 62}, r"needed 21 x 3 numbers"),
        ({"joint_sources": [None] * 20}, r"has 20 entries; needed 21"),
    ],
)
def test_an_annotation_that_cannot_be_right_is_refused_at_its_place(
    annotation: dict, said: str, make_set: MakeSet
) -> None:
    with pytest.raises(AnnotationError, match=said):
        read(make_set, annotations=[document()["annotations"][0] | annotation])


def test_absent_joints_have_no_place_whatever_the_file_has_there(make_set: MakeSet) -> None:
    marks = MARKS.copy()
    marks[4] = [300.0, 200.0, 0.0]
    annotation = document()["annotations"][0] | {"keypoints": marks.ravel().tolist()}
    item = only(read(make_set, ImportHints(pixel_centre=0.5), annotations=[annotation]))
    assert item.points[4].tolist() == [0.0, 0.0, 0.0] and item.points[5].tolist() == [49.5, 44.5, 2.0]

"""COCO-WholeBody: one person an image, hands that are valid, confidences that are no visibilities."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from tests.tracker.label_formats.conftest import MakeSet
from tracker.capture.annotations import Annotation
from tracker.capture.joint_source import JointSource
from tracker.errors import AnnotationError
from tracker.label_formats.coco_wholebody import read_coco_wholebody, write_coco_wholebody
from tracker.label_formats.label_set import ImportedLabels, ImportHints

MARKS = np.column_stack([np.arange(21) * 10.0, np.arange(21) * 5.0 + 20, np.tile([2.0, 1.0, 2.0], 7)])
FLAT = MARKS.ravel().tolist()


def read(make_set: MakeSet, *people: dict[str, Any], **hints: Any) -> ImportedLabels:
    images = [{"id": 5, "file_name": "cam1/color/000002.png"}, {"id": 6, "file_name": "elsewhere.png"}]
    document = {"images": images, "annotations": [{"image_id": 5} | person for person in people]}
    return read_coco_wholebody({"a.json": json.dumps(document).encode()}, [make_set()], ImportHints(**hints))


def sides(found: ImportedLabels) -> list[str]:
    return [item.hand for item in found.annotations["a" * 8].items]


def test_the_hands_of_an_image_are_those_of_one_person_with_a_box_around_both(make_set: MakeSet) -> None:
    away = MARKS + [100.0, 50.0, 0.0] * np.ones((21, 1))
    items = (
        Annotation(1, "cam0", "right", MARKS),
        Annotation(1, "cam0", "left", away),
        Annotation(2, "cam0", "left", MARKS),
    )
    written = json.loads(write_coco_wholebody([make_set(items)]).files["coco_wholebody.json"])
    both, alone = written["annotations"]
    assert (both["id"], both["image_id"], alone["id"], alone["image_id"]) == (1, 1, 2, 2)
    assert both["bbox"] == [0.0, 20.0, 301.0, 151.0]
    assert both["righthand_box"] == [0.0, 20.0, 201.0, 101.0] and both["lefthand_box"] == [100.0, 70.0, 201.0, 101.0]
    assert both["righthand_valid"] and both["lefthand_valid"] and alone["lefthand_valid"]
    assert not alone["righthand_valid"] and alone["righthand_kpts"] == [0] * 63
    assert len(written["categories"][0]["keypoints"]) * 3 == len(both["keypoints"]) == 51


def test_sources_come_back_with_their_hand(make_set: MakeSet) -> None:
    sources = (JointSource("track", "Track 1"), *(None,) * 20)
    items = (Annotation(1, "cam0", "right", MARKS, sources), Annotation(1, "cam0", "left", MARKS))
    files = write_coco_wholebody([make_set(items)]).files
    found = read_coco_wholebody(files, [make_set()], ImportHints()).annotations["a" * 8].items
    assert {item.hand: item.sources for item in found} == {"right": sources, "left": None}


@pytest.mark.parametrize(
    ("is_valid", "there"), [(True, ["left"]), (1, ["left"]), (False, []), (0, []), (None, ["left"])], ids=str
)
def test_a_hand_counts_when_it_is_valid_or_nothing_is_said_of_it(is_valid, there: list[str], make_set: MakeSet) -> None:
    person = {"lefthand_kpts": FLAT} | ({} if is_valid is None else {"lefthand_valid": is_valid})
    assert sides(read(make_set, person)) == there


@pytest.mark.parametrize("is_valid", ["yes", 2, []], ids=str)
def test_a_validity_that_is_none_is_refused(is_valid: object, make_set: MakeSet) -> None:
    with pytest.raises(AnnotationError, match=r"annotations\[0\]\.lefthand_valid .*; needed true or false"):
        read(make_set, {"lefthand_kpts": FLAT, "lefthand_valid": is_valid})


def test_a_confidence_is_taken_as_visible_and_told_but_one_stays_occluded(make_set: MakeSet) -> None:
    marks = MARKS.copy()
    marks[:4, 2] = [0.9, 0.1, 1.0, 0.0]
    found = read(make_set, {"righthand_kpts": marks.ravel().tolist()})
    (item,) = found.annotations["a" * 8].items
    assert item.points[:4, 2].tolist() == [2, 2, 1, 0]
    assert found.warnings[1:] == ("2 joints have a confidence for a visibility and were taken as visible.",)


def test_bodies_and_images_that_are_not_in_the_recording_are_left_out_and_told(make_set: MakeSet) -> None:
    found = read(
        make_set,
        {"righthand_kpts": FLAT, "num_keypoints": 17},
        {"num_keypoints": 3},
        {"num_keypoints": 0},
        {"image_id": 6, "righthand_kpts": FLAT, "num_keypoints": 5},
    )
    assert sides(found) == ["right"] and found.problems == ()
    assert "2 people have a body, which was left out." in found.warnings
    assert any("1 image is not in the recording" in warning for warning in found.warnings)


def test_a_hand_without_joints_is_no_hand(make_set: MakeSet) -> None:
    assert sides(read(make_set, {"righthand_kpts": [0] * 63, "lefthand_kpts": FLAT})) == ["left"]


def test_pixels_counted_from_the_corner_are_half_a_pixel_less(make_set: MakeSet) -> None:
    (item,) = read(make_set, {"righthand_kpts": FLAT}, pixel_centre=0.5).annotations["a" * 8].items
    assert np.array_equal(item.points, MARKS - [0.5, 0.5, 0.0] * np.ones((21, 1)))

"""COCO-WholeBody, its hands: `lefthand_kpts` and `righthand_kpts` of a person with `..._valid`.

Source: data_format.md of https://github.com/jin-s13/COCO-WholeBody. Pixels and v as in COCO; order of OpenPose, which
is ours. Body, face and feet are written as not labelled.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.capture.annotations import Annotation, parse_sources
from tracker.capture.document import Node
from tracker.label_formats.coco_images import MAX_ENTRIES, MAX_ID, list_images, read_images
from tracker.label_formats.coco_keypoints import describe_box, read_points, write_points
from tracker.label_formats.label_set import (
    ExportedLabels,
    ImportCollector,
    ImportedLabels,
    ImportHints,
    LabelSet,
    Notes,
    count_joints,
    note_outside,
)
from tracker.label_formats.orders import from_order, to_order
from tracker.label_formats.values import MAX_PIXEL, find_json, read_numbers, write_json

BODY = (
    *("nose", "left_eye", "right_eye", "left_ear", "right_ear", "left_shoulder", "right_shoulder", "left_elbow"),
    *("right_elbow", "left_wrist", "right_wrist", "left_hip", "right_hip", "left_knee", "right_knee", "left_ankle"),
    "right_ankle",
)
OTHERS = {"face_kpts": 68, "foot_kpts": 6}


def write_coco_wholebody(sets: list[LabelSet]) -> ExportedLabels:
    """One JSON file; the hands of an image are those of one person."""
    images, ids = list_images(sets)
    annotations: list[dict[str, Any]] = []
    losses = Notes()
    for item in sets:
        note_outside(losses, item.annotations.items, "COCO-WholeBody")
        hands: dict[int, list[Annotation]] = {}
        for own in item.annotations.items:
            hands.setdefault(ids[item.key, (own.camera, own.frame)], []).append(own)
        for image_id, both in sorted(hands.items()):
            annotations.append(_write_person(len(annotations) + 1, image_id, both))
    category = {"id": 1, "name": "person", "supercategory": "person", "keypoints": list(BODY), "skeleton": []}
    document = {
        "info": {"description": "Hand labels of Handloom", "version": "1"},
        "licenses": [],
        "images": images,
        "annotations": annotations,
        "categories": [category],
    }
    items = [own for item in sets for own in item.annotations.items]
    files = {"coco_wholebody.json": write_json(document)}
    return ExportedLabels(files, len(items), count_joints(items), losses.sentences())


def _write_person(id_: int, image_id: int, hands: list[Annotation]) -> dict[str, Any]:
    person: dict[str, Any] = {
        "id": id_,
        "image_id": image_id,
        "category_id": 1,
        "iscrowd": 0,
        "keypoints": [0] * (3 * len(BODY)),
        "num_keypoints": 0,
        **describe_box(np.concatenate([hand.points for hand in hands])),
        "face_box": [0.0, 0.0, 0.0, 0.0],
        "face_valid": False,
        "foot_valid": False,
        **{name: [0] * (3 * count) for name, count in OTHERS.items()},
    }
    for side in ("left", "right"):
        own = next((hand for hand in hands if hand.hand == side), None)
        points = np.zeros((21, 3)) if own is None else own.points
        person |= {} if own is None else own.describe_sources(f"{side}hand_sources")
        person[f"{side}hand_valid"] = bool((points[:, 2] > 0).any())
        person[f"{side}hand_box"] = describe_box(points)["bbox"]
        person[f"{side}hand_kpts"] = write_points(to_order(points, "coco_wholebody"))
    return person


def read_coco_wholebody(files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints) -> ImportedLabels:
    """The hands of a COCO-WholeBody file. Two people in one image are refused: a recording has two hands at most."""
    node = find_json(files, ".json")
    collector = ImportCollector(sets)
    images = read_images(node.get("images"), collector, hints)
    for item in node.get("annotations").items(MAX_ENTRIES):
        image = item.get("image_id").integer(0, MAX_ID)
        if image not in images:
            continue
        key, (camera, frame) = images[image]
        for side in ("right", "left"):
            if not item.has(f"{side}hand_kpts"):
                continue
            is_valid = item.get(f"{side}hand_valid").value if item.has(f"{side}hand_valid") else True
            if is_valid not in (True, False, 0, 1):
                item.get(f"{side}hand_valid").fail("true or false")
            if not is_valid:
                continue
            kpts = item.get(f"{side}hand_kpts")
            _note_floats(kpts, collector)
            points = from_order(read_points(kpts, hints, float_visibility=True), "coco_wholebody")
            if (points[:, 2] > 0).any():
                member = f"{side}hand_sources"  # our own; in our order, which is OpenPose's
                sources = parse_sources(item.get(member), range(21)) if item.has(member) else None
                collector.add(key, Annotation(frame, camera, side, points, sources))
        if item.has("num_keypoints") and item.get("num_keypoints").integer(0, 10**6):
            collector.warnings.add("{n} [person has|people have] a body, which was left out")
    return collector.finish()


def _note_floats(node: Node, collector: ImportCollector) -> None:
    seen = read_numbers(node, (21, 3), MAX_PIXEL)[:, 2]
    strange = int((~np.isin(seen, (0, 1, 2)) & (seen > 0)).sum())
    collector.warnings.add(
        "{n} [joint has|joints have] a confidence for a visibility and [was|were] taken as visible", count=strange
    )

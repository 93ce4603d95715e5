"""COCO keypoints: one category a hand, 21 joints each; loads in pycocotools.

Source: https://cocodataset.org/#format-data. Keypoints are positions of pixels, the top-left one being (0, 0), as
ours; a box is measured from the corner of the image, half a pixel further. v as ours.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotation, parse_sources
from tracker.capture.document import Node
from tracker.errors import AnnotationError
from tracker.label_formats.coco_images import MAX_ENTRIES, MAX_ID, list_images, read_images
from tracker.label_formats.label_set import (
    ExportedLabels,
    ImportCollector,
    ImportedLabels,
    ImportHints,
    LabelSet,
    Notes,
    count_joints,
    is_outside,
    note_outside,
)
from tracker.label_formats.orders import read_names
from tracker.label_formats.values import MAX_PIXEL, find_json, read_numbers, write_json
from tracker.model.joints import HAND_EDGES, HAND_JOINTS

Array = npt.NDArray[np.float64]
PIXEL_CENTRE = 0.0
"""Coordinate of the centre of the top-left pixel in `keypoints`."""
BOX_CENTRE = 0.5
"""The same in `bbox`."""
SOURCES = "joint_sources"
"""Our own member of an annotation: where each joint came from, as in annotations.json. Other programs pass it over."""
CATEGORIES = {"right": 1, "left": 2}


def write_coco_keypoints(sets: list[LabelSet]) -> ExportedLabels:
    """One JSON file with the labels of all recordings."""
    images, ids = list_images(sets)
    annotations: list[dict[str, Any]] = []
    losses = Notes()
    for item in sets:
        note_outside(losses, item.annotations.items, "COCO")
        for own in item.annotations.items:
            annotations.append(
                {
                    "id": len(annotations) + 1,
                    "image_id": ids[item.key, (own.camera, own.frame)],
                    "category_id": CATEGORIES[own.hand],
                    "iscrowd": 0,
                    "keypoints": write_points(own.points),
                    "num_keypoints": int((own.points[:, 2] > 0).sum()),
                    **describe_box(own.points),
                    **own.describe_sources(SOURCES),
                }
            )
    categories = [
        {
            "id": id_,
            "name": f"{hand}_hand",
            "supercategory": "hand",
            "keypoints": list(HAND_JOINTS),
            "skeleton": [[a + 1, b + 1] for a, b in HAND_EDGES],
        }
        for hand, id_ in CATEGORIES.items()
    ]
    info = {"description": "Hand labels of Handloom", "version": "1"}
    document = {
        "info": info,
        "licenses": [],
        "images": images,
        "annotations": annotations,
        "categories": categories,
    }
    joints = sum(count_joints(item.annotations.items) for item in sets)
    return ExportedLabels({"coco_keypoints.json": write_json(document)}, len(annotations), joints, losses.sentences())


def write_points(points: Array) -> list[float | int]:
    """x1, y1, v1, x2 ...; a joint that is not there is (0, 0, 0)."""
    flat: list[float | int] = []
    for x, y, v in points:
        flat += [float(x) + PIXEL_CENTRE, float(y) + PIXEL_CENTRE, int(v)] if v > 0 else [0, 0, 0]
    return flat


def describe_box(points: Array) -> dict[str, Any]:
    """`bbox` (x, y, width, height) around the joints, whole pixels taken in, and its `area`."""
    there = points[points[:, 2] > 0, :2]
    if len(there) == 0:
        return {"bbox": [0.0, 0.0, 0.0, 0.0], "area": 0.0}
    low, high = there.min(axis=0) + BOX_CENTRE - 0.5, there.max(axis=0) + BOX_CENTRE + 0.5
    width, height = (high - low).tolist()
    return {"bbox": [*low.tolist(), width, height], "area": width * height}


def read_coco_keypoints(files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints) -> ImportedLabels:
    """Hands of a COCO file. Which side a hand is must be said: by its category, or by the hint `hand`."""
    node = find_json(files, ".json")
    collector = ImportCollector(sets)
    categories = _read_categories(node.get("categories"), hints)
    images = read_images(node.get("images"), collector, hints)
    known = {item.get("id").value for item in node.get("images").items(10**6)}
    for item in node.get("annotations").items(MAX_ENTRIES):
        category = item.get("category_id").integer(0, MAX_ID)
        image = item.get("image_id").integer(0, MAX_ID)
        if category not in categories:
            collector.warnings.add("{n} [annotation|annotations] of categories that are no hands [was|were] left out")
        elif image not in known:
            item.get("image_id").fail("the id of one of the images")
        elif image in images:
            hand, order = categories[category]
            key, (camera, frame) = images[image]
            points = read_points(item.get("keypoints"), hints)
            ours = np.zeros((len(HAND_JOINTS), 3))
            ours[order] = points
            sources = parse_sources(item.get(SOURCES), np.argsort(order).tolist()) if item.has(SOURCES) else None
            collector.add(key, Annotation(frame, camera, hand, ours, sources))
    return collector.finish()


def read_points(node: Node, hints: ImportHints, *, float_visibility: bool = False) -> Array:
    """(21, 3) x, y, v as in the file's order, shifted to our pixel centres."""
    points = read_numbers(node, (len(HAND_JOINTS), 3), MAX_PIXEL)
    if float_visibility:
        points[:, 2] = np.where(points[:, 2] == 1, 1, np.where(points[:, 2] > 0, 2, 0))
    if not np.isin(points[:, 2], (0, 1, 2)).all():
        node.fail("visibilities 0 (absent), 1 (occluded) or 2 (visible)")
    points[:, :2] -= PIXEL_CENTRE if hints.pixel_centre is None else hints.pixel_centre
    points[points[:, 2] == 0] = 0.0
    assert not is_outside(points).any()
    return points


def _read_categories(node: Node, hints: ImportHints) -> dict[int, tuple[str, list[int]]]:
    """Hand and joint order of each category that is a hand."""
    found: dict[int, tuple[str, list[int]]] = {}
    unsided: list[str] = []
    for item in node.items(1000):
        name = item.get("name").text(200)
        if not item.has("keypoints"):
            continue
        words = name.lower().replace("-", "_").replace(" ", "_").split("_")
        side = next((hand for hand in ("right", "left") if hand in words or f"{hand}hand" in words), hints.hand)
        joints = [joint.text(100) for joint in item.get("keypoints").items(1000)]
        if "hand" not in name.lower() and len(joints) != len(HAND_JOINTS):
            continue
        order = read_names(joints, f"{node.file}: the category {name!r}")
        if side is None:
            unsided.append(name)
        else:
            found[item.get("id").integer(0, MAX_ID)] = (side, order)
    if unsided:
        raise AnnotationError(
            f"{node.file}: the category {unsided[0]!r} does not say whether it is the right or the left hand. "
            "Say it with the option hand (right or left), or name the categories right_hand and left_hand."
        )
    if not found:
        raise AnnotationError(f"{node.file}: no category is a hand with 21 named keypoints.")
    return found

"""InterHand2.6M: `..._data.json`, `..._camera.json`, `..._joint_3d.json` and `skeleton.txt`.

Source: https://mks0601.github.io/InterHand2.6M/ and its reader data/InterHand2.6M/dataset.py. World coordinates are mm;
x_camera = camrot (x_world - campos); 42 joints, the right hand first, each finger from tip to base, the wrist last.
It holds 3D joints and what a camera sees is their projection: no distortion, no occlusion. Pixel centres are whole
numbers (its projection adds nothing to `princpt`). A recording is one capture; `camera` is our camera's id.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotation
from tracker.capture.camera import Camera
from tracker.capture.document import Node
from tracker.capture.recorded_camera import RecordedCamera
from tracker.errors import AnnotationError
from tracker.label_formats.coco_images import MAX_ENTRIES, MAX_ID, list_images, read_images
from tracker.label_formats.coco_keypoints import describe_box
from tracker.label_formats.joints_3d import Hand3D, find_hands_3d, project_hand
from tracker.label_formats.label_set import (
    ExportedLabels,
    ImportCollector,
    ImportedLabels,
    ImportHints,
    LabelSet,
    Notes,
    note_flat_visibility,
)
from tracker.label_formats.orders import from_order, to_order
from tracker.label_formats.values import MAX_LENGTH_M, find_json, read_numbers, write_json
from tracker.model.joints import FINGERS, SIDES

Array = npt.NDArray[np.float64]
MM_PER_M = 1000.0
"""Its world is in millimetres."""
CAPTURE = "0"
PREFIX = "InterHand2.6M_train"
TOLERANCE_PX, TOLERANCE_M = 0.5, 0.001
"""Calibrations that differ by less are the recording's own, px and m."""


def write_interhand(sets: list[LabelSet]) -> ExportedLabels:
    """The four files; refused when no joint is known in 3D."""
    (only,) = sets
    losses = Notes()
    note_flat_visibility(losses, only.annotations.items, "InterHand2.6M")
    frames = _find_frames(only, losses)
    kept = tuple(item for item in only.annotations.items if item.hand in frames.get(item.frame, {}))
    images, ids = list_images([dataclasses.replace(only, annotations=type(only.annotations)(kept))])
    for image in images:
        image |= {"capture": int(CAPTURE), "subject": 0, "seq_name": only.sequence.name, "frame_idx": image["frame"]}
    annotations = []
    for frame, hands in frames.items():
        for camera in sorted({name for hand in hands.values() for name in hand.labels}):
            image_id = ids[only.key, (camera, frame)]
            annotations.append({"id": len(annotations) + 1, "image_id": image_id} | _write_view(camera, hands))
    world = {str(frame): _write_world(hands) for frame, hands in frames.items()}
    for camera in only.sequence.cameras:
        losses.add("{n} [camera has|cameras have] lens distortion, which InterHand2.6M does not hold", camera.id,
                   count=int(bool(camera.distortion.any())))  # fmt: skip
    files = {
        f"{PREFIX}_data.json": write_json({"images": images, "annotations": annotations}),
        f"{PREFIX}_camera.json": write_json({CAPTURE: _write_cameras(only.sequence.cameras)}),
        f"{PREFIX}_joint_3d.json": write_json({CAPTURE: world}),
        "skeleton.txt": _write_skeleton(),
    }
    joints = sum(int(np.sum(item["joint_valid"])) for item in annotations)
    count = sum(len(hand.labels) for hands in frames.values() for hand in hands.values())
    return ExportedLabels(files, count, joints, losses.sentences())


def _find_frames(labels: LabelSet, losses: Notes) -> dict[int, dict[str, Hand3D]]:
    """Hands by side in each frame where a joint of them is known in 3D."""
    frames: dict[int, dict[str, Hand3D]] = {}
    for hand in find_hands_3d(labels, losses):
        if np.isfinite(hand.points).all(axis=1).any():
            frames.setdefault(hand.frame, {})[hand.hand] = hand
    if not frames:
        raise AnnotationError(
            "InterHand2.6M holds 3D joints only, and none of these labels is known in 3D: mark joints in two "
            f"calibrated cameras, where there is depth, or give a track. {' '.join(losses.sentences())}"
        )
    return frames


def _write_world(hands: dict[str, Hand3D]) -> dict[str, Any]:
    points, valid = _join(hands)
    return {
        "world_coord": (np.where(valid[:, None], points, 0.0) * MM_PER_M).tolist(),
        "joint_valid": valid.astype(int)[:, None].tolist(),
        "hand_type": _hand_type(hands),
        "hand_type_valid": 1,
    }


def _write_view(camera: str, hands: dict[str, Hand3D]) -> dict[str, Any]:
    """Hands of a frame that have labels in this camera."""
    seen = {side: hand for side, hand in hands.items() if camera in hand.labels}
    marks = np.concatenate([hand.labels[camera].points for hand in seen.values()])
    return {
        "bbox": describe_box(marks)["bbox"],
        "joint_valid": _join(seen)[1].astype(int)[:, None].tolist(),
        "hand_type": _hand_type(seen),
        "hand_type_valid": True,
    }


def _join(hands: dict[str, Hand3D]) -> tuple[Array, npt.NDArray[np.bool_]]:
    """(42, 3) world, m, and (42,) whether known, in InterHand2.6M's order."""
    nothing = np.full((21, 3), np.nan)
    both = np.concatenate([to_order(hands[side].points if side in hands else nothing, "interhand") for side in SIDES])
    return both, np.asarray(np.isfinite(both).all(axis=1))


def _hand_type(hands: dict[str, Any]) -> str:
    return "interacting" if len(hands) == 2 else next(iter(hands))


def _write_cameras(cameras: tuple[RecordedCamera, ...]) -> dict[str, Any]:
    return {
        "campos": {c.id: (c.T_world_camera[:3, 3] * MM_PER_M).tolist() for c in cameras},
        "camrot": {c.id: c.T_camera_world[:3, :3].tolist() for c in cameras},
        "focal": {c.id: [c.K[0, 0], c.K[1, 1]] for c in cameras},
        "princpt": {c.id: [c.K[0, 2], c.K[1, 2]] for c in cameras},
    }


def _write_skeleton() -> bytes:
    """Name, number and parent of each of the 42 joints."""
    lines = []
    for offset, side in ((0, "r"), (21, "l")):
        for number, finger in enumerate(FINGERS):
            name = "pinky" if finger == "little" else finger
            for step in range(4):
                own = 4 * number + step
                parent = 20 if step == 3 else own + 1
                lines.append(f"{side}_{name}{4 - step} {own + offset} {parent + offset}")
        lines.append(f"{side}_wrist {20 + offset} -1")
    return ("\n".join(lines) + "\n").encode()


def read_interhand(files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints) -> ImportedLabels:
    """The 3D joints as each camera of the file sees them."""
    (only,) = sets
    collector = ImportCollector(sets)
    data, cameras, world = (find_json(files, f"_{what}.json") for what in ("data", "camera", "joint_3d"))
    images = read_images(data.get("images"), collector, hints)
    by_id = {item.get("id").value: item for item in data.get("images").items(10**6)}
    eyes: dict[tuple[str, str], Camera] = {}
    for item in data.get("annotations").items(MAX_ENTRIES):
        image_id = item.get("image_id").integer(0, MAX_ID)
        if image_id not in images:
            continue
        camera, frame = images[image_id][1]
        capture = str(by_id[image_id].get("capture").integer(0, 10**6))
        if (capture, camera) not in eyes:
            eyes[capture, camera] = _read_camera(cameras.get(capture), by_id[image_id], only, camera, collector)
        entry = world.get(capture).get(str(by_id[image_id].get("frame_idx").integer(0, 10**9)))
        points = read_numbers(entry.get("world_coord"), (42, 3), MAX_LENGTH_M * MM_PER_M) / MM_PER_M
        valid = read_numbers(item.get("joint_valid"), (42,), 1.0) > 0
        kind = item.get("hand_type").choice("right", "left", "interacting")
        for number, side in enumerate(SIDES):
            part = slice(21 * number, 21 * number + 21)
            if kind in (side, "interacting") and valid[part].any():
                own, known = (
                    from_order(points[part], "interhand"),
                    from_order(valid[part][:, None].astype(np.float64), "interhand")[:, 0],
                )
                marked = project_hand(eyes[capture, camera], own, known.astype(np.bool_))
                collector.add(only.key, Annotation(frame, camera, side, marked))
                collector.warnings.add(
                    "InterHand2.6M does not say what is occluded; of {n} [hand|hands] every joint seen is visible"
                )
    return collector.finish()


def _read_camera(capture: Node, image: Node, labels: LabelSet, camera_id: str, collector: ImportCollector) -> Camera:
    recorded = labels.sequence.camera(camera_id)
    name = str(image.get("camera").value)[:64]
    focal = read_numbers(capture.get("focal").get(name), (2,), 1e6)
    centre = read_numbers(capture.get("princpt").get(name), (2,), 1e6)
    position = read_numbers(capture.get("campos").get(name), (3,), MAX_LENGTH_M * MM_PER_M) / MM_PER_M
    node = capture.get("camrot").get(name)
    R = read_numbers(node, (3, 3), 2.0)
    if np.abs(R @ R.T - np.eye(3)).max() > 1e-3 or np.linalg.det(R) < 0:
        node.fail("a rotation matrix")
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R.T, position
    K = np.array([[focal[0], 0, centre[0]], [0, focal[1], centre[1]], [0, 0, 1]])
    away = np.linalg.norm(T[:3, 3] - recorded.T_world_camera[:3, 3])
    if np.abs(K - recorded.K).max() > TOLERANCE_PX or away > TOLERANCE_M:
        collector.warnings.add(
            "{n} [camera has|cameras have] another calibration than in the recording; [its|their] own was used",
            name,
        )
    return Camera(camera_id, recorded.width, recorded.height, K, recorded.distortion, T)

"""FreiHAND: `training_xyz.json` and `training_K.json`, one entry a sample: 3D joints in the camera, m.

Source: utils/fh_utils.py of https://github.com/lmb-freiburg/freihand. Order of OpenPose, which is ours. It holds right
hands with all 21 joints only, no 2D, no visibility; its images are `training/rgb/%08d.jpg`. Pixel centres are whole
numbers (its projection adds nothing to K). Sample n is made findable by `handloom_samples.json`, which is ours.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from tracker.capture.annotations import Annotation
from tracker.capture.camera import Camera
from tracker.capture.document import Node, parse_json
from tracker.errors import AnnotationError, say_count
from tracker.label_formats.joints_3d import find_hands_3d, project_hand
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
from tracker.label_formats.values import MAX_ENTRIES, MAX_LENGTH_M, find_json, read_numbers, write_json

SAMPLES_FILE = "handloom_samples.json"
K_TOLERANCE = 0.5
"""px that a file's intrinsics may differ from the recording's without a warning."""


def write_freihand(sets: list[LabelSet]) -> ExportedLabels:
    """The lists of samples; refused when not a single right hand is known whole in 3D."""
    (only,) = sets
    losses = Notes()
    note_flat_visibility(losses, only.annotations.items, "FreiHAND")
    lefts = sum(item.hand == "left" for item in only.annotations.items)
    losses.add("{n} left [hand was|hands were] left out: FreiHAND holds right hands only", count=lefts)
    right = dataclasses.replace(only, annotations=type(only.annotations)(
        tuple(item for item in only.annotations.items if item.hand == "right")
    ))  # fmt: skip
    xyz, Ks, samples = [], [], []
    for hand in find_hands_3d(right, losses):
        if not np.isfinite(hand.points).all():
            where = f"frame {hand.frame}"
            losses.add("{n} right [hand was|hands were] left out: FreiHAND needs all 21 joints in 3D", where)
            continue
        for camera_id in hand.labels:
            camera = only.sequence.camera(camera_id)
            T = camera.T_camera_world
            points = hand.points @ T[:3, :3].T + T[:3, 3]
            xyz.append(to_order(points, "freihand").tolist())
            Ks.append(camera.K.tolist())
            name = only.names.name((camera_id, hand.frame))
            samples.append({"camera": camera_id, "frame": hand.frame, "hand": "right", "file_name": name})
            losses.add(
                "FreiHAND's projection knows no lens distortion, which {n} [sample has|samples have]",
                count=int(bool(camera.distortion.any())),
            )
    if not xyz:
        raise AnnotationError(
            "FreiHAND holds 3D joints only, and no right hand of these labels has all 21 joints in 3D: mark them in "
            "two calibrated cameras or where there is depth, or give a track.",
            losses.sentences(),
        )
    files = {
        "training_xyz.json": write_json(xyz),
        "training_K.json": write_json(Ks),
        SAMPLES_FILE: write_json(samples),
    }
    return ExportedLabels(files, len(xyz), 21 * len(xyz), losses.sentences())


def read_freihand(files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints) -> ImportedLabels:
    """Joints of the samples, seen by the camera of each; which image a sample is must be known."""
    (only,) = sets
    collector = ImportCollector(sets)
    xyz = list(find_json(files, "_xyz.json").items(MAX_ENTRIES))
    Ks = list(find_json(files, "_K.json").items(MAX_ENTRIES))
    if len(xyz) != len(Ks):
        raise AnnotationError(f"..._xyz.json has {len(xyz)} samples and ..._K.json {len(Ks)}; needed as many.")
    places = _read_places(files, only, len(xyz), hints, collector)
    for node, K_node, place in zip(xyz, Ks, places, strict=True):
        points = from_order(read_numbers(node, (21, 3), MAX_LENGTH_M), "freihand")
        K = read_numbers(K_node, (3, 3), 1e6)
        if place is None:
            continue
        recorded = only.sequence.camera(place[0])
        if np.abs(K - recorded.K).max() > K_TOLERANCE:
            collector.warnings.add(
                "{n} [sample has|samples have] other intrinsics than the recording; [its|theirs] were used", place[0]
            )
        eye = Camera(recorded.id, recorded.width, recorded.height, K, recorded.distortion)
        marked = project_hand(eye, points, np.ones(21, dtype=np.bool_))
        collector.add(only.key, Annotation(place[1], place[0], "right", marked))
    collector.warnings.add("FreiHAND does not say what is occluded; of {n} [hand|hands] every joint seen is visible",
                           count=len(xyz))  # fmt: skip
    return collector.finish()


def _read_places(
    files: dict[str, bytes], labels: LabelSet, count: int, hints: ImportHints, collector: ImportCollector
) -> list[tuple[str, int] | None]:
    cameras = [camera.id for camera in labels.sequence.cameras]
    name = next((name for name in files if name.split("/")[-1] == SAMPLES_FILE), None)
    if name is None:
        camera = hints.camera or (cameras[0] if len(cameras) == 1 else None)
        if camera not in cameras or count != labels.sequence.frame_count:
            frames = say_count(labels.sequence.frame_count, "frame")
            raise AnnotationError(
                f"FreiHAND does not say which image a sample is, and {say_count(count, 'sample')} cannot be matched "
                f"with {frames} of {say_count(len(cameras), 'camera')}: add the file {SAMPLES_FILE}, "
                "or choose the camera.",
                (
                    f"{SAMPLES_FILE} is a list with 'camera', 'frame' and 'file_name' for each sample, in their order; "
                    "an export from here has it.",
                    "Without it there must be one sample for each frame, and the option camera says whose frames.",
                ),
            )
        return [(camera, frame) for frame in range(count)]
    samples = list(parse_json(files[name], name, AnnotationError).items(MAX_ENTRIES))
    if len(samples) != count:
        raise AnnotationError(f"{name} names {len(samples)} samples where there are {count}.")
    return [_find_sample(sample, labels, cameras, collector) for sample in samples]


def _find_sample(
    sample: Node, labels: LabelSet, cameras: list[str], collector: ImportCollector
) -> tuple[str, int] | None:
    camera = sample.get("camera").text(64)
    frame = sample.get("frame").integer(0, 10**9)
    if sample.has("hand"):
        sample.get("hand").choice("right")
    if sample.has("file_name"):
        file_name = sample.get("file_name").text(1024)
        found = labels.names.find(file_name, camera)
        if len(found) == 1:
            if found[0] != (camera, frame):
                collector.warnings.add(
                    "{n} [sample was|samples were] taken by file name; [its|their] frame number says otherwise",
                    file_name,
                )
            return found[0]
    if camera in cameras and frame < labels.sequence.frame_count:
        return camera, frame
    collector.warnings.add(
        "{n} [sample is|samples are] not in the recording and [was|were] left out", f"frame {frame} of {camera}"
    )
    return None

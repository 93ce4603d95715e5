"""Our own `annotations.json`: holds everything, one recording a file."""

from __future__ import annotations

from tracker.capture.annotations import parse_annotations
from tracker.errors import AnnotationError
from tracker.label_formats.label_set import (
    ExportedLabels,
    ImportCollector,
    ImportedLabels,
    ImportHints,
    LabelSet,
    count_joints,
)
from tracker.label_formats.values import find_json, write_json


def write_handloom(sets: list[LabelSet]) -> ExportedLabels:
    """The file."""
    (only,) = sets
    items = only.annotations.items
    return ExportedLabels({"annotations.json": write_json(only.annotations.to_json())}, len(items), count_joints(items))


def read_handloom(files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints) -> ImportedLabels:
    """What the file holds, places that the recording does not have being a problem."""
    (only,) = sets
    if hints.pixel_centre not in (None, 0.0):
        raise AnnotationError(
            "annotations.json has pixel centres at whole numbers by contract; leave pixel_centre out."
        )
    collector = ImportCollector(sets)
    cameras = {camera.id for camera in only.sequence.cameras}
    for item in parse_annotations(find_json(files, ".json")).items:
        if item.camera not in cameras or item.frame >= only.sequence.frame_count:
            place = f"frame {item.frame} of {item.camera}"
            collector.problems.add(
                "{n} [hand is in an image|hands are in images] that the recording does not have", place
            )
        else:
            collector.add(only.key, item)
    return collector.finish()

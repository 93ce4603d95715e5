"""Handloom's science: frames and scans in, poses and models out. Runs without the server.

What other programs may use is listed here and loaded when it is first asked for: `import tracker` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tracker.capture.annotations import Annotation, Annotations, load_annotations, save_annotations
    from tracker.capture.archive import ArchiveLimits, extract_archive
    from tracker.capture.camera import Camera
    from tracker.capture.frame import Frame
    from tracker.capture.import_check import IMPORT_FORMATS, check_import
    from tracker.capture.import_options import ImportOptions
    from tracker.capture.import_report import ImportReport
    from tracker.capture.import_run import run_import
    from tracker.capture.relative_path import find_path_fault
    from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json
    from tracker.errors import AnnotationError, FrameError, ImportRefusedError, SequenceError, TrackerError
    from tracker.model.joints import HAND_EDGES, HAND_JOINTS

_HOMES = {
    "Annotation": "tracker.capture.annotations",
    "AnnotationError": "tracker.errors",
    "Annotations": "tracker.capture.annotations",
    "ArchiveLimits": "tracker.capture.archive",
    "Camera": "tracker.capture.camera",
    "Frame": "tracker.capture.frame",
    "FrameError": "tracker.errors",
    "HAND_EDGES": "tracker.model.joints",
    "HAND_JOINTS": "tracker.model.joints",
    "IMPORT_FORMATS": "tracker.capture.import_check",
    "ImportOptions": "tracker.capture.import_options",
    "ImportRefusedError": "tracker.errors",
    "ImportReport": "tracker.capture.import_report",
    "Sequence": "tracker.capture.sequence",
    "SequenceError": "tracker.errors",
    "TrackerError": "tracker.errors",
    "check_import": "tracker.capture.import_check",
    "extract_archive": "tracker.capture.archive",
    "find_path_fault": "tracker.capture.relative_path",
    "load_annotations": "tracker.capture.annotations",
    "load_sequence": "tracker.capture.sequence",
    "run_import": "tracker.capture.import_run",
    "save_annotations": "tracker.capture.annotations",
    "save_sequence_json": "tracker.capture.sequence",
}

__all__ = [
    "HAND_EDGES",
    "HAND_JOINTS",
    "IMPORT_FORMATS",
    "Annotation",
    "AnnotationError",
    "Annotations",
    "ArchiveLimits",
    "Camera",
    "Frame",
    "FrameError",
    "ImportOptions",
    "ImportRefusedError",
    "ImportReport",
    "Sequence",
    "SequenceError",
    "TrackerError",
    "check_import",
    "extract_archive",
    "find_path_fault",
    "load_annotations",
    "load_sequence",
    "run_import",
    "save_annotations",
    "save_sequence_json",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tracker' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

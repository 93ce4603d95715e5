"""Handloom's science: frames and scans in, poses and models out. Runs without the server.

What other programs may use is listed here and loaded when it is first asked for: `import tracker` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tracker.capture.annotations import Annotation, Annotations, load_annotations, save_annotations
    from tracker.capture.camera import Camera
    from tracker.capture.frame import Frame
    from tracker.capture.sequence import Sequence, load_sequence
    from tracker.errors import AnnotationError, SequenceError, TrackerError
    from tracker.model.joints import HAND_EDGES, HAND_JOINTS

_HOMES = {
    "Annotation": "tracker.capture.annotations",
    "AnnotationError": "tracker.errors",
    "Annotations": "tracker.capture.annotations",
    "Camera": "tracker.capture.camera",
    "Frame": "tracker.capture.frame",
    "HAND_EDGES": "tracker.model.joints",
    "HAND_JOINTS": "tracker.model.joints",
    "Sequence": "tracker.capture.sequence",
    "SequenceError": "tracker.errors",
    "TrackerError": "tracker.errors",
    "load_annotations": "tracker.capture.annotations",
    "load_sequence": "tracker.capture.sequence",
    "save_annotations": "tracker.capture.annotations",
}

__all__ = [
    "HAND_EDGES",
    "HAND_JOINTS",
    "Annotation",
    "AnnotationError",
    "Annotations",
    "Camera",
    "Frame",
    "Sequence",
    "SequenceError",
    "TrackerError",
    "load_annotations",
    "load_sequence",
    "save_annotations",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tracker' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

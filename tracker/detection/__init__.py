"""Salient points, [T16] §3.2.5: a Hough forest that finds fingertips, and their assignment to a model's fingertips."""

from tracker.detection.assignment import assign_detections
from tracker.detection.default_detector import default_detector
from tracker.detection.detect import find_fingertips, find_in_image
from tracker.detection.detection import Detection
from tracker.detection.forest import Forest
from tracker.detection.forest_files import load_forest, save_forest
from tracker.detection.own_detector import OwnDetector, load_detector
from tracker.detection.patch_image import PatchImage

__all__ = [
    "Detection",
    "Forest",
    "OwnDetector",
    "PatchImage",
    "assign_detections",
    "default_detector",
    "find_fingertips",
    "find_in_image",
    "load_detector",
    "load_forest",
    "save_forest",
]

"""Salient points, [T16] §3.2.5: a Hough forest that finds fingertips, and their assignment to a model's fingertips."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.detection.assignment import assign_detections
    from tracker.detection.detect import find_fingertips, find_in_image
    from tracker.detection.detection import Detection
    from tracker.detection.forest import Forest
    from tracker.detection.forest_files import load_forest, save_forest
    from tracker.detection.image_hands import DETECTOR_LABEL, find_image_hands
    from tracker.detection.own_detector import OwnDetector, load_detector
    from tracker.detection.patch_image import PatchImage
    from tracker.detection.recorded_hands import (
        RecordedHands,
        choose_views,
        detect_hands,
        join_recorded_hands,
        load_recorded_hands,
    )

__getattr__, __dir__ = offer(__name__)

"""How well a detector finds the fingertips of annotated images."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tracker.detection.annotated_images import AnnotatedImage
from tracker.detection.detect import DetectOptions, find_in_image
from tracker.detection.forest import Forest
from tracker.detection.suppression import compute_overlaps
from tracker.evaluation.detections import JudgedImage, PrecisionRecall, compute_precision_recall, judge_boxes

ANY_CONFIDENCE = DetectOptions(min_confidence=0.05, stride=1)
"""A curve also needs detections of low confidence."""


def judge_detector(
    forest: Forest, images: Iterable[AnnotatedImage], options: DetectOptions = ANY_CONFIDENCE
) -> PrecisionRecall:
    """Precision and recall over annotated images.

    A fingertip's box is centred at its annotation and as large as the detector's boxes are at its depth; where there is
    no depth at it, at the hand's.
    """
    return compute_precision_recall([judge_image(forest, item, options) for item in images])


def judge_image(forest: Forest, item: AnnotatedImage, options: DetectOptions = ANY_CONFIDENCE) -> JudgedImage:
    """The detections of one image, judged."""
    peaks = find_in_image(forest, item.image, options)
    half = 0.5 * forest.box_size * item.image.focal / _tip_depths(item)[:, None]
    truth = np.concatenate([item.tips - half, item.tips + half], axis=1)
    return judge_boxes(peaks.confidences, compute_overlaps(peaks.boxes, truth), item.is_visible)


def _tip_depths(item: AnnotatedImage) -> np.ndarray:
    """(T,) depth at each fingertip, m: of the nearest pixel with one within 3 px, or of the median pixel of hand."""
    depth = item.image.depth
    known = depth[item.image.mask & (depth > 0.0)]
    depths = np.full(len(item.tips), float(np.median(known)) if known.size else 1.0)
    for index, (x, y) in enumerate(item.tips):
        column, row = int(np.rint(x)), int(np.rint(y))
        window = depth[max(0, row - 3) : max(0, row + 4), max(0, column - 3) : max(0, column + 4)]
        if window.size and (window > 0.0).any():
            depths[index] = float(np.median(window[window > 0.0]))
    return depths

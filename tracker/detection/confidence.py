"""What a confidence means."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.detection.forest import Forest

C_THR = 3.0
"""Confidence from which detections are used, [T16] §3.2.5."""


def calibrate_confidence(
    forest: Forest,
    confidences: npt.NDArray[np.float64],
    precision: npt.NDArray[np.float64],
    wanted: float = 0.8,
) -> Forest:
    """The forest with confidences scaled so that of the detections above `C_THR` at least `wanted` are right.

    Differs from the paper: there 3.0 belongs to the scale of its own forest's votes. Where no threshold is that
    precise, the most precise one is taken.

    Args:
        forest: A trained forest.
        confidences: (N,) of its detections in images that it was not trained on, largest first.
        precision: (N,) share of right ones among those at least as confident.
        wanted: Precision at `C_THR`.
    """
    assert confidences.shape == precision.shape
    # The first few detections may be wrong by chance; a threshold is taken where precision holds for good reason.
    settled = np.arange(len(confidences)) >= min(20, len(confidences) - 1)
    good = np.flatnonzero(settled & (precision >= min(wanted, float(np.max(precision[settled], initial=0.0)))))
    if len(good) == 0 or confidences[good[-1]] <= 0.0:
        return forest
    return replace(forest, confidence_scale=forest.confidence_scale * C_THR / float(confidences[good[-1]]))

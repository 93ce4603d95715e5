"""At confidence 3.0 most detections are right."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.detection.toys import PATCHES, SMALL, disc_patches
from tracker.detection.confidence import C_THR, calibrate_confidence
from tracker.detection.training import train_forest


@pytest.fixture(scope="module")
def forest():
    return train_forest(disc_patches(4), PATCHES, replace(SMALL, trees=1))


def test_the_lowest_confidence_with_the_wanted_precision_becomes_the_threshold(forest):
    confidences = np.linspace(10.0, 0.1, 100)
    precision = np.where(np.arange(100) < 60, 0.95, 0.5)
    scaled = calibrate_confidence(forest, confidences, precision)
    assert scaled.confidence_scale * confidences[59] == pytest.approx(C_THR)


def test_where_nothing_is_that_precise_the_most_precise_counts(forest):
    confidences = np.linspace(10.0, 0.1, 100)
    precision = 0.5 - 0.3 * np.abs(np.arange(100) - 40) / 100
    assert calibrate_confidence(forest, confidences, precision).confidence_scale == pytest.approx(
        C_THR / confidences[40]
    )


def test_without_detections_nothing_changes(forest):
    assert calibrate_confidence(forest, np.zeros(0), np.zeros(0)) == forest

"""Precision, recall and area under the curve, by hand."""

import numpy as np
import pytest

from tracker.evaluation.detections import JudgedImage, compute_precision_recall, judge_boxes


def test_a_fingertip_is_found_once_by_the_best_detection():
    overlaps = np.array([[0.7, 0.1], [0.9, 0.0], [0.2, 0.6], [0.0, 0.4]])
    judged = judge_boxes(np.array([2.0, 5.0, 1.0, 3.0]), overlaps, np.array([True, True]))
    np.testing.assert_array_equal(judged.confidences, [5.0, 3.0, 2.0, 1.0])
    np.testing.assert_array_equal(judged.is_true, [True, False, False, True])
    assert judged.num_truths == 2


def test_detections_of_occluded_fingertips_count_neither_way():
    judged = judge_boxes(np.array([2.0, 1.0]), np.array([[0.8], [0.3]]), np.array([False]))
    np.testing.assert_array_equal(judged.confidences, [1.0])  # the other overlaps it too little to be excused
    assert not judged.is_true.any()
    assert judged.num_truths == 0


def test_without_fingertips_every_detection_is_wrong():
    judged = judge_boxes(np.array([2.0]), np.zeros((1, 0)), np.zeros(0, dtype=bool))
    np.testing.assert_array_equal(judged.is_true, [False])


def test_the_curve_and_its_area_over_several_images():
    images = [
        JudgedImage(np.array([9.0, 7.0]), np.array([True, False]), 2),
        JudgedImage(np.array([8.0, 6.0]), np.array([True, True]), 2),
    ]
    curve = compute_precision_recall(images)
    np.testing.assert_array_equal(curve.confidences, [9.0, 8.0, 7.0, 6.0])
    np.testing.assert_allclose(curve.precision, [1.0, 1.0, 2 / 3, 3 / 4])
    np.testing.assert_allclose(curve.recall, [0.25, 0.5, 0.5, 0.75])
    # Precision made monotone from the right: 1 up to recall 0.5, 3/4 up to 0.75, nothing beyond.
    assert curve.auc == pytest.approx(0.5 * 1.0 + 0.25 * 0.75)
    assert curve.at(8.0) == (1.0, 0.5)
    assert curve.at(100.0) == (1.0, 0.0)
    assert (curve.num_truths, curve.num_images) == (4, 2)


def test_a_perfect_detector_has_area_one_and_none_has_zero():
    assert compute_precision_recall([JudgedImage(np.ones(5), np.ones(5, dtype=bool), 5)]).auc == pytest.approx(1.0)
    assert compute_precision_recall([JudgedImage(np.zeros(0), np.zeros(0, dtype=bool), 5)]).auc == 0.0
    assert compute_precision_recall([]).auc == 0.0


def test_the_order_of_images_does_not_matter(rng):
    images = [JudgedImage(rng.random(6), rng.random(6) < 0.6, 7) for _ in range(5)]
    assert compute_precision_recall(images).auc == pytest.approx(compute_precision_recall(images[::-1]).auc)

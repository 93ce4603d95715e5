"""Overlap of boxes, and which of them stay."""

import numpy as np
import pytest

from tracker.detection.suppression import compute_overlaps, suppress


def test_overlap_is_intersection_over_union():
    boxes = np.array([[0.0, 0, 10, 10], [5.0, 0, 15, 10], [20.0, 20, 30, 30], [3.0, 3, 3, 3]])
    overlaps = compute_overlaps(boxes, boxes)
    assert overlaps[0, 0] == 1.0
    assert overlaps[0, 1] == overlaps[1, 0] == pytest.approx(1.0 / 3.0)
    assert overlaps[0, 2] == 0.0
    assert overlaps[3, 3] == 0.0  # a box without area overlaps nothing


def test_of_boxes_that_overlap_by_more_than_half_the_best_stays():
    boxes = np.array([[0.0, 0, 10, 10], [2.0, 0, 12, 10], [5.0, 0, 15, 10], [2.5, 0, 12.5, 10]])
    np.testing.assert_array_equal(suppress(boxes, np.array([1.0, 3.0, 2.0, 0.5]), 0.5), [1])
    # Once 1 is gone, 2 hides 3 but not 0.
    np.testing.assert_array_equal(suppress(boxes[[0, 2, 3]], np.array([1.0, 2.0, 0.5]), 0.5), [1, 0])


def test_no_two_that_stay_overlap_and_every_other_overlaps_a_better_one(rng):
    corner = rng.uniform(0, 100, (60, 2))
    boxes = np.concatenate([corner, corner + rng.uniform(10, 30, (60, 1))], axis=1)
    confidences = rng.random(60)
    kept = suppress(boxes, confidences, 0.5)
    overlaps = compute_overlaps(boxes, boxes)
    assert (overlaps[np.ix_(kept, kept)] - np.eye(len(kept)) <= 0.5).all()
    for other in set(range(60)) - set(kept.tolist()):
        better = kept[confidences[kept] >= confidences[other]]
        assert overlaps[other, better].max() > 0.5


def test_nothing_stays_nothing():
    assert suppress(np.zeros((0, 4)), np.zeros(0), 0.5).shape == (0,)

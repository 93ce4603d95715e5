"""Eq. 14 is solved exactly, virtual nodes included."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.detection.assignment import assign_detections


def cost_of(found, distances, weights, rejection):
    """The sum of Eq. 14 for an assignment."""
    detections, fingertips = distances.shape
    taken = [t for t in found if t >= 0]
    assert len(set(taken)) == len(taken), "a fingertip is used once"
    paired = sum(distances[s, t] for s, t in enumerate(found) if t >= 0)
    false = sum(weights[s] for s in range(detections) if found[s] < 0)
    return paired + rejection * false + rejection * (fingertips - len(taken))


def every_assignment(detections, fingertips):
    choices = list(range(fingertips)) + [-1] * detections
    return set(permutations(choices, detections))


@settings(max_examples=60, deadline=None)
@given(
    detections=st.integers(0, 3),
    fingertips=st.integers(0, 3),
    seed=st.integers(0, 10**6),
    rejection=st.floats(0.0, 0.2),
    uses_confidence=st.booleans(),
)
def test_the_solution_costs_no_more_than_any_other(detections, fingertips, seed, rejection, uses_confidence):
    rng = np.random.default_rng(seed)
    distances = rng.uniform(0.0, 0.15, (detections, fingertips))
    weights = rng.uniform(1.0, 4.0, detections) if uses_confidence else np.ones(detections)
    found = assign_detections(distances, weights, rejection)
    best = min(
        cost_of(other, distances, weights, rejection) for other in every_assignment(detections, fingertips) or {()}
    )
    assert cost_of(found, distances, weights, rejection) == pytest.approx(best, abs=1e-12)


def test_a_pair_is_accepted_up_to_lambda_times_one_plus_its_weight():
    for weight in (1.0, 2.5):
        limit = 0.02 * (1.0 + weight)
        assert assign_detections(np.array([[limit - 1e-6]]), np.array([weight]), 0.02)[0] == 0
        assert assign_detections(np.array([[limit + 1e-6]]), np.array([weight]), 0.02)[0] == -1


def test_a_false_positive_and_a_fingertip_without_detection_leave_the_others_alone():
    distances = np.array([[0.005, 0.060, 0.090], [0.500, 0.600, 0.700], [0.080, 0.004, 0.060]])
    np.testing.assert_array_equal(assign_detections(distances, np.ones(3), 0.02), [0, -1, 1])


def test_without_lambda_every_detection_is_a_false_positive():
    np.testing.assert_array_equal(assign_detections(np.full((2, 5), 0.001), np.ones(2), 0.0), [-1, -1])


def test_more_detections_than_fingertips_and_none_at_all():
    assert sorted(assign_detections(np.full((3, 1), 0.001), np.ones(3), 0.1)) == [-1, -1, 0]
    assert assign_detections(np.zeros((0, 5)), np.zeros(0), 0.1).shape == (0,)
    np.testing.assert_array_equal(assign_detections(np.zeros((2, 0)), np.ones(2), 0.1), [-1, -1])


def test_an_impossible_pair_is_never_chosen():
    found = assign_detections(np.array([[np.inf, 0.01], [np.inf, 0.02]]), np.ones(2), 5.0)
    np.testing.assert_array_equal(found, [1, -1])

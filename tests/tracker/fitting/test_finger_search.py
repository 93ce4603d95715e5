"""Fingers are tried at other bends: never for the worse, and each without moving the others."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.fitting.finger_search import (
    BASE_CURLS,
    GAIN,
    OUTER_CURLS,
    curl_fingers,
    list_finger_angles,
    measure_curl,
    search_fingers,
    swap_fingers,
)
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS

HANDS = [default_hand("right"), default_hand("left")]


@pytest.fixture(params=HANDS, ids=["right", "left"])
def hand(request) -> ArticulatedModel:
    return request.param


def random_pose(hand: ArticulatedModel, rng: np.random.Generator) -> np.ndarray:
    """(D,) with every joint inside its limits."""
    return np.r_[rng.normal(size=6), rng.uniform(hand.skeleton.lower, hand.skeleton.upper)]


def test_every_angle_of_a_hand_is_of_one_finger_at_most_and_the_fingers_have_as_many(hand):
    own = [list_finger_angles(hand, finger) for finger in range(5)]
    together = np.concatenate(own)
    assert len(np.unique(together)) == len(together) <= len(hand.skeleton.dof_bones)
    assert all(len(angles) >= 4 for angles in own)
    for finger, angles in zip(FINGERS, own, strict=True):
        bones = {hand.skeleton.bone_names[bone] for bone in hand.skeleton.dof_bones[angles]}
        assert bones and all(finger in bone for bone in bones)


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 1.0])
def test_a_curl_that_is_given_is_the_curl_that_is_measured(hand, share):
    assert measure_curl(hand, curl_fingers(hand, share)) == pytest.approx(share)


def test_curled_fingers_are_within_their_limits_and_a_hand_bent_beyond_them_measures_a_fist(hand):
    fist = curl_fingers(hand, 1.0)
    assert np.all((fist >= hand.skeleton.lower) & (fist <= hand.skeleton.upper))
    assert measure_curl(hand, 3.0 * fist) == 1.0
    assert measure_curl(hand, -fist) == 0.0


def test_swapping_two_straight_or_two_evenly_bent_fingers_is_nothing(hand):
    straight = np.r_[np.arange(6.0), np.zeros(hand.num_dofs - 6)]
    for swapped in swap_fingers(straight, 0, hand):
        np.testing.assert_array_equal(swapped, straight)
    bent = straight + np.r_[np.zeros(6), curl_fingers(hand, 0.4)]
    for place, swapped in enumerate(swap_fingers(bent, 0, hand)):
        moved = np.abs(swapped - bent) > 1e-12  # the little finger's base has a wide range to its side, too
        assert np.count_nonzero(moved) == (place == 2) and not swapped[moved].any()


def test_swapping_two_fingers_twice_is_nothing_but_that_they_point_straight_ahead(hand, rng):
    pose = random_pose(hand, rng)
    for place, swapped in enumerate(swap_fingers(pose, 0, hand)):
        back = swap_fingers(swapped, 0, hand)[place]
        again = swap_fingers(back, 0, hand)[place]
        np.testing.assert_allclose(again, swapped, atol=1e-12)
        kept = back != 0.0
        np.testing.assert_allclose(back[kept], pose[kept], atol=1e-12)


def test_swapping_moves_two_neighbours_and_nothing_else_of_the_scene(hand, rng):
    other = rng.normal(size=13)
    pose = np.r_[other, random_pose(hand, rng)]
    before = pose.copy()
    swapped = swap_fingers(pose, 13, hand)
    assert len(swapped) == 3  # index and middle, middle and ring, ring and little
    for place, each in enumerate(swapped):
        both = [13 + 6 + list_finger_angles(hand, finger) for finger in (1 + place, 2 + place)]
        moved = np.flatnonzero(each != pose)
        assert set(moved) <= set(np.concatenate(both)) and all(np.intersect1d(moved, own).size for own in both)
    np.testing.assert_array_equal(pose, before)


def test_a_search_never_lowers_the_score_and_moves_only_its_own_hand(hand, rng):
    pose = np.r_[rng.normal(size=13), random_pose(hand, rng), rng.normal(size=4)]
    weights = rng.normal(size=len(pose))

    def score(trial: np.ndarray) -> float:
        return float(np.sin(trial @ weights))

    found = search_fingers(pose, 13, hand, score)
    assert score(found) > score(pose)
    own = np.arange(13 + 6, 13 + hand.num_dofs)
    np.testing.assert_array_equal(np.delete(found, own), np.delete(pose, own))
    angles = found[own][found[own] != pose[own]]
    assert np.all(angles <= hand.skeleton.upper[found[own] != pose[own]] + 1e-12)
    assert np.all(angles >= hand.skeleton.lower[found[own] != pose[own]] - 1e-12)


@pytest.mark.parametrize("finger", range(5))
def test_a_search_finds_the_bend_of_each_finger_that_alone_scores_best(hand, finger):
    target = np.zeros(hand.num_dofs)
    own = 6 + list_finger_angles(hand, finger)
    target[own] = (np.r_[np.zeros(6), curl_fingers(hand, BASE_CURLS[1])])[own]

    def score(trial: np.ndarray) -> float:
        return -float(np.abs(trial - target).sum())

    found = search_fingers(np.zeros(hand.num_dofs), 0, hand, score)
    assert score(found) >= -np.abs(BASE_CURLS[1] - OUTER_CURLS[1]) * np.abs(curl_fingers(hand, 1.0)).sum()
    assert score(found) > score(np.zeros(hand.num_dofs)) + 0.3
    others = np.setdiff1d(np.arange(hand.num_dofs), own)
    assert np.all(found[others] == 0.0)


def test_a_change_that_gains_next_to_nothing_is_not_made(hand):
    pose = np.zeros(hand.num_dofs)

    def score(trial: np.ndarray) -> float:
        return 0.9 * GAIN * float(np.any(trial != pose))

    assert search_fingers(pose, 0, hand, score) is pose

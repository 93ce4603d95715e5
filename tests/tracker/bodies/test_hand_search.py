"""A hand is found in a pose nobody told, one that the scan lacks is called missing, and the other is left alone."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.bodies.posed_bodies import A_POSE, MODEL, apart, points_of, stand
from tracker.bodies.body_prior import make_body_prior
from tracker.bodies.body_state import SIDES
from tracker.bodies.hand_mixture import default_mixture
from tracker.bodies.hand_search import REACH, HandSearch
from tracker.model.body_hands import body_hand


@pytest.fixture(scope="module")
def search() -> HandSearch:
    return HandSearch(MODEL, make_body_prior(), default_mixture(), default_mixture())


def hands_like(gaussian: int) -> np.ndarray:
    return np.tile(default_mixture().first(6).means[gaussian], (2, 1))


@pytest.mark.parametrize("side", [0, 1])
def test_a_hand_held_otherwise_is_found_and_nothing_else_moves(search, side: int) -> None:
    truth, begun = stand(hands=hands_like(3)), stand(hands=hands_like(7))
    found = search.find(begun, points_of(truth), (side,))
    own = body_hand(MODEL, SIDES[side]).vertices
    assert found.are_shown == (True, True)
    assert apart(found.state, truth, own) < 4e-3 < 8e-3 < apart(begun, truth, own), "m"
    other = body_hand(MODEL, SIDES[1 - side]).vertices
    assert np.allclose(found.state.posed(MODEL).vertices[other], begun.posed(MODEL).vertices[other], atol=1e-12)


@pytest.mark.parametrize("missing", SIDES)
def test_a_hand_without_points_is_missing_and_stays_as_it_was(search, missing: str) -> None:
    begun = stand(hands=hands_like(7))
    k = SIDES.index(missing)
    found = search.find(begun, points_of(stand(hands=hands_like(3)), without=(missing,)), (k,))
    assert found.are_shown[k] is False and found.are_shown[1 - k] is True
    assert np.array_equal(found.state.pose, begun.pose) and np.array_equal(found.state.hands, begun.hands)


def test_points_of_a_hand_are_near_it_and_not_those_that_the_trunk_is_nearer_to(search) -> None:
    state = stand(A_POSE)
    for k, side in enumerate(SIDES):
        points = search.points_of(state, points_of(state), k).points
        middle = state.posed(MODEL).joints[body_hand(MODEL, side).fingers].mean(axis=0)
        assert np.linalg.norm(points - middle, axis=1).max() < REACH
        assert np.sign(points[:, 0]).min() == np.sign(points[:, 0]).max() == (1.0 if side == "left" else -1.0)


def test_a_hand_is_covered_by_its_own_points_alone(search) -> None:
    state = stand()
    for k, side in enumerate(SIDES):
        assert search.covered_share(state, points_of(state), k) == 1.0
        assert search.covered_share(state, points_of(state, without=(side,)), k) < 0.1


def test_starts_are_all_poses_of_the_mixture_in_every_turn_of_the_forearm_and_the_pose_as_it_is(search) -> None:
    state = stand(hands=hands_like(7))
    starts = search._starts(0, state)
    assert len(starts) == 4 * len(search.means) + 1
    assert np.array_equal(starts[0].pose, state.pose)
    wrists = np.array([start.posed(MODEL).joints[body_hand(MODEL, "left").wrist] for start in starts])
    assert np.ptp(wrists, axis=0).max() < 2e-3, "m; a forearm turned about itself leaves the wrist where it is"

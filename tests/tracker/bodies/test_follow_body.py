"""A person is followed from scan to scan; a hand that is lost is held, one that comes back is searched and found."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.bodies.posed_bodies import A_POSE, MODEL, apart, registration_of, scan_of, stand, turned
from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.follow_body import BodyFollower, FollowOptions, choose_mixture
from tracker.bodies.hand_mixture import default_mixture
from tracker.model.body_hands import body_hand

FIST, FLAT = (np.tile(default_mixture().first(6).means[k], (2, 1)) for k in (3, 7))
BEFORE = stand(A_POSE, FLAT)
NOW = stand(A_POSE + turned(left_shoulder=(0, -4, 5), right_elbow=(0, 6, 0), spine1=(2, 0, 0)), FLAT, (0.02, 0, 0.03))


@pytest.fixture(scope="module")
def follower() -> BodyFollower:
    return BodyFollower(MODEL)


@pytest.fixture(scope="module")
def followed(follower) -> BodyRegistration:
    return follower.follow(scan_of(NOW), registration_of(BEFORE))


def test_a_body_that_moved_a_little_is_found_where_it_is_now_within_a_millimetre(followed) -> None:
    assert apart(BEFORE, NOW) > 0.03, "m"
    off = np.linalg.norm(followed.vertices - NOW.posed(MODEL).vertices, axis=1)
    assert 1e3 * off.mean() < 1.0 and followed.verdict == "good" and followed.are_shown == (True, True)


def test_a_hand_that_the_scan_does_not_show_is_held_as_it_was(follower) -> None:
    found = follower.follow(scan_of(NOW, without=("left",)), registration_of(BEFORE))
    assert found.are_shown == (False, True)
    size = BEFORE.hands.shape[1]
    assert np.abs(found.state.hands[0, :size] - BEFORE.hands[0]).max() < 0.05, "rad"


@pytest.mark.slow
def test_a_hand_that_has_come_back_in_another_pose_is_searched(follower) -> None:
    now = stand(A_POSE, FIST)
    found = follower.follow(scan_of(now), registration_of(BEFORE, shown=(False, True)))
    own = body_hand(MODEL, "left").vertices
    off = np.linalg.norm(found.vertices[own] - now.posed(MODEL).vertices[own], axis=1)
    assert found.are_shown == (True, True) and 1e3 * off.mean() < 3.0, "mm"


@pytest.mark.parametrize(
    ("shown", "was_shown", "options", "hands"),
    [
        ((True, True), (True, True), FollowOptions(), (30.0, 30.0)),
        ((False, True), (True, True), FollowOptions(), (1000.0, 30.0)),
        ((True, True), (False, True), FollowOptions(), (0.0, 30.0)),
        ((False, True), (True, True), FollowOptions(holds_hands=False), (0.0, 30.0)),
        ((False, True), (True, True), FollowOptions(has_velocity=False), (1000.0, 0.0)),
    ],
)
def test_a_frame_is_held_to_the_one_before_except_by_a_hand_that_has_just_come_back(
    shown, was_shown, options, hands
) -> None:
    anchor = BodyFollower(MODEL, options)._anchor(registration_of(BEFORE, shown=was_shown), shown)
    assert tuple(anchor.hands) == hands and anchor.body == (30.0 if options.has_velocity else 0.0)
    assert anchor.state is not NOW and np.array_equal(anchor.state.pose, BEFORE.pose)


def test_one_gaussian_has_one_mean_and_no_prior_none() -> None:
    mixture, one = choose_mixture("mixture"), choose_mixture("gaussian")
    assert mixture is not None and one is not None and choose_mixture("none") is None
    assert len(mixture.shares) == 10 and len(one.shares) == 1
    assert np.allclose(one.means[0], mixture.shares @ mixture.means)

"""A stiff body is laid onto a scan from wherever it stands and looks, and the same start is not followed twice."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.tracker.bodies.posed_bodies import A_POSE, MODEL, apart, points_of, stand, turned
from tracker.bodies.body_fit import BodyFit
from tracker.bodies.body_prior import make_body_prior
from tracker.bodies.body_start import APART, NEAR, SETTLED, BodyStart, Stiff, _kabsch, _turns, start_poses
from tracker.bodies.hand_mixture import default_mixture
from tracker.registration.scan_points import ScanPoints


@pytest.fixture(scope="module")
def start() -> BodyStart:
    return BodyStart(BodyFit(MODEL, make_body_prior(), default_mixture(), 6))


def facing(yaw_deg: float, place: tuple[float, float, float]):
    pose = A_POSE.copy()
    pose[0] = np.radians([0.0, yaw_deg, 0.0])
    return stand(pose, place=place)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_points_that_were_moved_stiffly_are_laid_back_whatever_their_weights(seed: int) -> None:
    rng = np.random.default_rng(seed)
    source, R = rng.standard_normal((12, 3)), Rotation.from_quat(rng.standard_normal(4)).as_matrix()
    t = rng.standard_normal(3)
    found_R, found_t = _kabsch(source, source @ R.T + t, rng.uniform(0.1, 1.0, 12))
    assert np.allclose(found_R, R, atol=1e-9) and np.allclose(found_t, t, atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_what_no_turn_explains_is_laid_by_a_turn_all_the_same_and_never_by_a_mirror(seed: int) -> None:
    rng = np.random.default_rng(seed)
    source = rng.standard_normal((8, 3))
    R, _ = _kabsch(source, source * np.array([-1.0, 1.0, 1.0]), np.ones(8))
    assert np.allclose(R @ R.T, np.eye(3), atol=1e-9) and np.linalg.det(R) > 0.0


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_directions_to_look_are_turns_and_one_of_them_is_near_to_that_of_a_standing_body(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cloud = rng.standard_normal((60, 3)) * np.array([0.25, 0.6, 0.12])
    true = Rotation.from_quat(rng.standard_normal(4))
    turns = np.array(_turns(true.apply(cloud - cloud.mean(axis=0))))
    assert np.allclose(turns @ turns.transpose(0, 2, 1), np.eye(3), atol=1e-9)
    assert np.allclose(np.linalg.det(turns), 1.0)
    assert (true.inv() * Rotation.from_matrix(turns)).magnitude().min() < np.radians(45.0)


def test_every_start_pose_lets_both_feet_hang_down_and_differs_from_the_others() -> None:
    poses = np.array(start_poses())
    assert len({pose.tobytes() for pose in poses}) == len(poses) == 10
    for pose in poses:
        joints = stand(pose).posed(MODEL).joints
        assert joints[[7, 8], 1].max() < joints[0, 1] - 0.6 < joints[15, 1]


@pytest.mark.parametrize(("yaw", "place"), [(20.0, (0, 0, 0)), (200.0, (1.0, -0.5, 2.0)), (-85.0, (0, 3.0, 0))])
def test_the_best_stiff_body_stands_where_the_scanned_one_does_and_looks_the_same_way(start, yaw, place) -> None:
    state = facing(yaw, place)
    best = start.find_stiff(points_of(state))[0]
    turn = Rotation.from_matrix(best.R) * Rotation.from_rotvec(state.pose[0]).inv()
    assert turn.magnitude() < np.radians(12.0)
    (followed,) = start.follow([best])
    assert np.linalg.norm(followed.posed(MODEL).joints[0] - state.posed(MODEL).joints[0]) < 0.06, "m"
    assert apart(followed, state) < 0.1


def test_a_body_that_lies_on_its_scan_is_settled_and_one_beside_it_is_not(start) -> None:
    state = facing(0.0, (0, 0, 0))
    scan = points_of(state)
    assert start.is_settled(_evaluated(start, state), scan)
    assert not start.is_settled(_evaluated(start, facing(0.0, (0.06, 0, 0.06))), scan)


def test_a_body_of_which_one_foot_is_folded_back_is_not_settled(start) -> None:
    folded = stand(A_POSE + turned(right_ankle=(-108, 0, 0), right_foot=(34, 0, 0)))
    surface = stand().posed(MODEL).vertices[start.fit.inner[:3000]]
    surface = surface[surface[:, 1] > surface[:, 1].min() + 0.03]  # nobody sees the soles of one who stands
    scan = ScanPoints(surface, np.zeros_like(surface))
    matches = start.fit.search.match(folded.posed(MODEL).vertices, surface, np.zeros_like(surface), reach=1.0)
    assert np.mean(np.abs(matches.offsets) > NEAR) < SETTLED, "a small part of the body"
    assert start.is_settled(_evaluated(start, stand()), scan)
    assert not start.is_settled(_evaluated(start, folded), scan)


def test_starts_that_are_followed_differ_in_pose_or_direction_and_no_direction_has_more_than_three(start) -> None:
    stiff = [
        Stiff(pose, Rotation.from_rotvec([0.0, np.radians(yaw), 0.0]).as_matrix(), np.zeros(3), float(number))
        for number, (pose, yaw) in enumerate((pose, yaw) for yaw in (0.0, 10.0, 180.0) for pose in range(6))
    ]
    followed = start.follow(stiff)
    yaws = np.array([state.pose[0, 1] for state in followed])
    assert len(followed) == 6, "three for each of two directions; 10 degrees are no other"
    assert sorted(np.round(np.degrees(np.abs(yaws)))) == [0.0, 0.0, 0.0, 180.0, 180.0, 180.0] and np.pi > APART


def _evaluated(start: BodyStart, state):
    class Found:
        posed = start.fit.pose(state)

    return Found()

"""A hand comes to the places of its joints, from wherever it starts and wherever in the world it is."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.scenes import CAMERA, move_pose, palm_to_camera
from tracker.fitting.finger_search import curl_fingers
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.search.joint_descent import JointDescent, align
from tracker.terms.marked_joints import mark_joints

HAND = default_hand("right")
SCENE = Scene((HAND,))
ALL = np.ones(21, dtype=np.bool_)


def joints_of(pose: np.ndarray) -> np.ndarray:
    return SCENE.pose_at(pose).landmarks(0)


def descent_to(joints: np.ndarray, is_placed: np.ndarray = ALL, v: np.ndarray | float = 2.0) -> JointDescent:
    points = np.column_stack([CAMERA.project(joints), np.broadcast_to(v, 21)])
    return JointDescent(SCENE, mark_joints(SCENE, 0, points, CAMERA), joints, is_placed)


@pytest.mark.parametrize("count", [3, 4, 21])
def test_points_that_were_moved_are_carried_back_onto_themselves(rng, count):
    points = rng.normal(size=(count, 3))
    for twist in rng.normal(scale=2.0, size=(5, 6)):
        T = se3.exp(twist)
        np.testing.assert_allclose(align(points, se3.transform(T, points)), T, atol=1e-9)


def test_an_alignment_is_a_motion_and_no_mirror_and_no_motion_near_by_is_better(rng):
    source, target = rng.normal(size=(2, 8, 3))
    for goal in (target, source * (-1.0, 1.0, 1.0)):
        T = align(source, goal)
        assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)
        np.testing.assert_allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-12)
        least = np.sum((se3.transform(T, source) - goal) ** 2)
        for step in rng.normal(scale=1e-2, size=(20, 6)):
            assert np.sum((se3.transform(se3.exp(step) @ T, source) - goal) ** 2) > least


def test_to_align_there_and_back_is_nothing(rng):
    source, target = rng.normal(size=(2, 8, 3))
    np.testing.assert_allclose(align(source, target) @ align(target, source), np.eye(4), atol=1e-9)


def test_one_point_or_points_in_one_place_are_carried_there_without_a_mirror():
    for count in (1, 5):
        source, target = np.ones((count, 3)), np.full((count, 3), 4.0)
        T = align(source, target)
        np.testing.assert_allclose(se3.transform(T, source), target, atol=1e-12)
        assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)


@pytest.mark.parametrize("curl", [0.0, 0.5])
def test_at_rest_on_joints_of_the_same_bend_a_hand_lies_on_them_also_if_few_are_known(curl):
    pose = palm_to_camera(HAND, (0.03, -0.02, 0.5), curl)
    known = np.isin(np.arange(21), (0, 5, 17))
    joints = joints_of(pose)
    told = np.where(known[:, None], joints, 7.0)  # what is not known pulls nowhere
    for places, which in ((joints, ALL), (told, known)):
        rest = JointDescent(SCENE, mark_joints(SCENE, 0, np.zeros((21, 3)), CAMERA), places, which).rest(
            curl_fingers(HAND, curl), which
        )
        np.testing.assert_allclose(joints_of(rest), joints, atol=1e-9)


def test_a_descent_reaches_a_bend_that_is_half_a_fist_away_and_costs_less_the_nearer_it_comes():
    joints = joints_of(palm_to_camera(HAND, (0.0, 0.0, 0.45), 0.5))
    descent = descent_to(joints)
    rest = descent.rest(curl_fingers(HAND, 0.0), ALL)
    costs, apart = [], []
    for steps in (1, 3, 12):
        pose, cost = descent.descend(rest, rest, steps)
        costs.append(cost)
        apart.append(float(np.linalg.norm(joints_of(pose) - joints, axis=1).mean()))
    assert costs == sorted(costs, reverse=True) and apart == sorted(apart, reverse=True)
    assert apart[-1] < 3.5e-3 < 0.015 < apart[0]  # m; the nearness to rest holds it back


def test_no_step_is_where_it_starts_at_no_known_cost():
    descent = descent_to(joints_of(palm_to_camera(HAND, (0.0, 0.0, 0.45))))
    rest = descent.rest(curl_fingers(HAND, 0.3), ALL)
    pose, cost = descent.descend(rest, rest, 0)
    np.testing.assert_array_equal(pose, rest)
    assert cost == np.inf


def test_places_that_are_not_known_pull_nobody_but_the_rays_do():
    joints = joints_of(palm_to_camera(HAND, (0.0, 0.0, 0.45), 0.3))
    near, far = descent_to(joints, ~ALL), descent_to(joints * 1.4, ~ALL)  # the same rays
    rest = near.rest(curl_fingers(HAND, 0.3), ALL)
    np.testing.assert_allclose(near.descend(rest, rest, 4)[0], far.descend(rest, rest, 4)[0], atol=1e-9)
    placed = descent_to(joints * 1.02, ALL)
    depths = [joints_of(one.descend(rest, rest, 6)[0])[:, 2].mean() for one in (near, placed)]
    assert depths[1] > depths[0] + 1e-3


def test_a_hand_elsewhere_in_the_world_is_reached_just_so():
    T = se3.exp(np.array([1.0, -0.5, 2.0, 0.0, 0.0, 0.0]))
    joints = joints_of(palm_to_camera(HAND, (0.0, 0.0, 0.45), 0.5))
    rays = np.zeros((21, 3))  # by their places alone
    here, there = (
        JointDescent(SCENE, mark_joints(SCENE, 0, rays, CAMERA), places, ALL)
        for places in (joints, se3.transform(T, joints))
    )
    start = here.rest(curl_fingers(HAND, 0.0), ALL)
    moved = move_pose(SCENE, T, start)
    one, cost = here.descend(start, start, 6)
    other, other_cost = there.descend(moved, moved, 6)
    np.testing.assert_allclose(other[6:], one[6:], atol=1e-6)
    assert other_cost == pytest.approx(cost, rel=1e-6)

"""Joints of each person, with the poses of their registrations carried along."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.training.fingers import PARENTS, Fingers, make_fingers
from tracker.model.skinning import keep_heaviest
from tracker.training.joints import fit_joints
from tracker.training.pose_fit import Hands, Poses
from tracker.training.rig import Rig, place, place_at


@pytest.fixture(scope="module")
def fingers() -> Fingers:
    return make_fingers(people=3, poses=8)


@pytest.fixture(scope="module")
def hands(fingers) -> Hands:
    """As they were made, but their joints a millimetre or two off."""
    rig = Rig(PARENTS, keep_heaviest(fingers.weights), fingers.directions)
    joints = fingers.joints + np.random.default_rng(0).normal(scale=1e-3, size=fingers.joints.shape)
    return Hands(fingers.targets, fingers.owners, fingers.templates, joints, rig)


@pytest.fixture(scope="module")
def start(fingers) -> Poses:
    return Poses(fingers.rotations, fingers.translations, np.full(24, 9.0))


def measure(poses: Poses, hands: Hands, joints: np.ndarray) -> np.ndarray:
    """(N,) root mean square distance of the vertices, m."""
    costs = [
        place_at(
            hands.rig, hands.templates[s], joints[s], (poses.rotations[n], poses.translations[n]), hands.targets[n]
        ).cost
        for n, s in enumerate(hands.owners)
    ]
    return np.sqrt(np.array(costs) / hands.targets.shape[1])


def test_joints_that_are_off_come_back_and_the_poses_with_them(fingers, hands, start):
    before = measure(start, hands, hands.joints)
    poses, joints = fit_joints(start, hands, hands.joints, 1e-6, 20)
    assert poses.errors.max() < 0.02e-3 < 0.2e-3 < before.max()
    np.testing.assert_allclose(poses.errors, measure(poses, hands, joints), rtol=1e-6)
    posed = [
        place(hands.rig, hands.templates[s], joints[s], poses.rotations[n], poses.translations[n]).joints
        for n, s in enumerate(hands.owners)
    ]
    assert np.linalg.norm(posed - fingers.posed_joints, axis=2)[:, 1:].max() < 0.3e-3


def test_where_a_hinge_tells_nothing_joints_stay_where_they_were_expected():
    """Bent about the y axis only, a joint may lie anywhere along y; across it, it is found."""
    fingers = make_fingers(people=1, poses=12, with_bulges=False)
    template, joints = fingers.templates[0], fingers.joints[0]
    owners, turns = np.zeros(12, dtype=int), np.zeros((12, 4, 3))
    turns[:, 1:, 1] = 0.1 * np.arange(12)[:, None] + 0.05 * np.arange(1, 4)
    rotations = Rotation.from_rotvec(turns.reshape(-1, 3)).as_matrix().reshape(12, 4, 3, 3)
    rig = Rig(PARENTS, keep_heaviest(fingers.weights), np.zeros((*template.shape, 0)))
    targets = np.stack([place(rig, template, joints, R, np.zeros(3)).vertices for R in rotations])
    expected = joints + np.array([[0, 0, 0], [0.002, 0.003, 0.002], [0.002, -0.003, 0.001], [0.001, 0.002, -0.002]])
    start = Poses(rotations, np.zeros((12, 3)), np.zeros(12))
    hands = Hands(targets, owners, template[None], expected[None], rig)
    _, found = fit_joints(start, hands, expected[None], 1e-3, 30)
    np.testing.assert_allclose(found[0, 1:, [0, 2]], joints[1:, [0, 2]].T, atol=0.1e-3)
    np.testing.assert_allclose(found[0, 1:, 1], expected[1:, 1], atol=0.1e-3)


def test_stiff_joints_go_where_they_are_expected_whatever_registrations_say(hands, start):
    expected = hands.joints + 0.002
    _, joints = fit_joints(start, hands, expected, 1e6, 10)
    np.testing.assert_allclose(joints, expected, atol=1e-6)


def test_the_root_which_turns_with_nothing_stays_where_it_is_expected(hands, start):
    """A turn about another point is made up for by the translation."""
    expected = hands.joints + np.array([0.001, -0.002, 0.003])
    _, joints = fit_joints(start, hands, expected, 1e-4, 30)
    np.testing.assert_allclose(joints[:, 0], expected[:, 0], atol=1e-5)


def test_without_a_step_nothing_moves_and_a_person_without_registrations_keeps_theirs(hands, start):
    poses, joints = fit_joints(start, hands, hands.joints, 1e-6, 0)
    np.testing.assert_array_equal(joints, hands.joints)
    np.testing.assert_array_equal(poses.rotations, start.rotations)
    np.testing.assert_allclose(poses.errors, measure(start, hands, hands.joints))
    of_two = replace(hands, owners=np.where(hands.owners == 1, 0, hands.owners))
    poses, joints = fit_joints(start, of_two, hands.joints, 1e-6, 1)
    np.testing.assert_array_equal(joints[1], hands.joints[1])
    assert np.abs(joints[2] - hands.joints[2]).max() > 1e-6


def test_people_are_fitted_each_alone_and_threads_change_nothing(hands, start):
    before = start.rotations.copy(), hands.joints.copy()
    one, two = (fit_joints(start, hands, hands.joints, 1e-6, 3, threads) for threads in (1, 2))
    assert one[1].tobytes() == two[1].tobytes() and one[0].rotations.tobytes() == two[0].rotations.tobytes()
    np.testing.assert_array_equal(start.rotations, before[0])
    np.testing.assert_array_equal(hands.joints, before[1])
    mine = hands.owners == 1
    alone = Hands(hands.targets[mine], np.zeros(8, dtype=np.int64), hands.templates[1:2], hands.joints[1:2], hands.rig)
    own = Poses(start.rotations[mine], start.translations[mine], start.errors[mine])
    np.testing.assert_array_equal(fit_joints(own, alone, alone.joints, 1e-6, 3)[1][0], one[1][1])


def test_progress_reaches_the_end_and_can_cancel(hands, start):
    told: list[float] = []
    fit_joints(start, hands, hands.joints, 1e-6, 1, progress=told.append)
    assert told[-1] == 1.0 and told == sorted(told)

    def cancel(share: float) -> None:
        raise InterruptedError

    with pytest.raises(InterruptedError):
        fit_joints(start, hands, hands.joints, 1e-6, 1, progress=cancel)

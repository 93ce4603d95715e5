"""The kernels of the blend model against NumPy written as [R17] Eq. 1-4 are, and its derivative by differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.random_blend import random_blend, random_pose
from tracker.model.blend_kernels import (
    CHUNK,
    PosedArrays,
    blend_jacobian_into,
    find_ball_twists,
    move_balls_into,
    pose_into,
    regress_into,
    shape_into,
    turn_into,
)

MODEL = random_blend(num_shape=4)
ARRAYS = MODEL.arrays
POSE, SHAPE, TRANSLATION = random_pose(MODEL, 3)


def place(pose: np.ndarray, shape: np.ndarray, translation: np.ndarray) -> PosedArrays:
    posed = PosedArrays.empty(len(MODEL.template), MODEL.num_bones)
    shape_into(posed.shaped, ARRAYS, shape)
    pose_into(posed, ARRAYS, pose, translation)
    return posed


POSED = place(POSE, SHAPE, TRANSLATION)


def chain(Rs: np.ndarray, rest: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """(B, 4, 4) from rest to posed, as the product of the bones' own motions about their joints."""
    Ts = np.empty((len(Rs), 4, 4))
    for b, parent in enumerate(MODEL.parents):
        own = np.eye(4)
        own[:3, :3], own[:3, 3] = Rs[b], rest[b] - Rs[b] @ rest[b]
        if parent < 0:
            own[:3, 3] += translation
        Ts[b] = own if parent < 0 else Ts[parent] @ own
    return Ts


def test_the_shaped_template_and_its_joints_are_the_linear_maps_of_the_model():
    np.testing.assert_allclose(POSED.shaped, MODEL.template + MODEL.shape_directions @ SHAPE, atol=1e-15)
    joints = np.empty((MODEL.num_bones, 3))
    regress_into(joints, ARRAYS, POSED.shaped)
    np.testing.assert_allclose(joints, MODEL.joint_regressor @ POSED.shaped, atol=1e-15)


def test_bones_move_by_the_product_of_their_own_turns_about_their_joints():
    Rs, rest = Rotation.from_rotvec(POSE).as_matrix(), MODEL.joint_regressor @ POSED.shaped
    Ts, joints = np.empty((len(Rs), 3, 4)), np.empty((len(Rs), 3))
    move_balls_into(Ts, joints, Rs, rest, ARRAYS.parents, TRANSLATION)
    expected = chain(Rs, rest, TRANSLATION)
    np.testing.assert_allclose(Ts, expected[:, :3], atol=1e-13)
    np.testing.assert_allclose(joints, np.einsum("bxy,by->bx", Ts[:, :, :3], rest) + Ts[:, :, 3], atol=1e-13)


def test_a_posed_vertex_is_its_shape_and_pose_blend_carried_by_its_bones():
    Rs, rest = Rotation.from_rotvec(POSE).as_matrix(), MODEL.joint_regressor @ POSED.shaped
    surface = POSED.shaped + MODEL.pose_directions @ (Rs[1:] - np.eye(3)).ravel()
    Ts = np.einsum("vb,bxy->vxy", MODEL.skinning_weights, chain(Rs, rest, TRANSLATION)[:, :3])
    np.testing.assert_allclose(POSED.rest, surface, atol=1e-12)
    np.testing.assert_allclose(POSED.vertices, np.einsum("vxy,vy->vx", Ts[:, :, :3], surface) + Ts[:, :, 3], atol=1e-12)


def test_a_twist_of_a_bone_leaves_its_joint_where_it_is_and_turns_about_an_axis_of_its_parent():
    twists = find_ball_twists(POSED, ARRAYS.parents)
    np.testing.assert_array_equal(twists[3:6], np.eye(3, 6))
    for b, parent in enumerate(MODEL.parents):
        own = twists[:3] if parent < 0 else twists[3 + 3 * b : 6 + 3 * b]
        axes = np.eye(3) if parent < 0 else POSED.Ts[parent, :, :3].T
        np.testing.assert_allclose(own[:, 3:], axes, atol=1e-14)
        np.testing.assert_allclose(own[:, :3] + np.cross(own[:, 3:], POSED.joints[b]), 0.0, atol=1e-13)


@pytest.mark.parametrize("with_shape", [True, False])
def test_the_derivative_meets_finite_differences_in_every_direction(with_shape: bool):
    ids = np.random.default_rng(0).permutation(len(MODEL.template))[: CHUNK + 3]
    size = MODEL.num_parameters if with_shape else 3 + 3 * MODEL.num_bones
    jacobian = np.zeros((len(ids), 3, size))
    blend_jacobian_into(jacobian, ids, POSED, ARRAYS, True, with_shape)
    step = 1e-6
    for direction in np.random.default_rng(1).normal(size=(3, size)):
        ends = [place(*MODEL.retract(POSE, SHAPE, TRANSLATION, sign * step * direction)) for sign in (1, -1)]
        difference = (ends[0].vertices[ids] - ends[1].vertices[ids]) / (2 * step)
        np.testing.assert_allclose(jacobian @ direction, difference, atol=1e-7)


def test_turns_are_products_of_rotations_as_vectors_of_at_most_half_a_turn():
    rng = np.random.default_rng(2)
    pose, step = rng.normal(size=(50, 3)), rng.normal(size=(50, 3))
    pose[0], step[0] = 0.0, 0.0
    pose[1], step[1] = 1e-12, -1e-12
    pose[2], step[2] = [np.pi, 0, 0], [0, np.pi, 0]
    pose[3], step[3] = [2.0, 0, 0], [2.0, 0, 0]
    result = np.empty((50, 3))
    turn_into(result, pose, step)
    wanted = Rotation.from_rotvec(step) * Rotation.from_rotvec(pose)
    np.testing.assert_allclose(Rotation.from_rotvec(result).as_matrix(), wanted.as_matrix(), atol=1e-12)
    assert np.linalg.norm(result, axis=1).max() <= np.pi + 1e-12

"""A blend model moves as [R17] Eq. 1-4 say, and its derivatives are exact."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.tracker.model.mirrored_poses import mirror_blend_pose
from tests.tracker.random_blend import random_blend, random_pose
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel
from tracker.model.mirroring import MIRROR
from tracker.model.untrained_hand import untrained_hand

STEP = 1e-6


def plain_pose(model: BlendModel, pose, shape, translation):
    """[R17] Eq. 1-4 as they are written, with dense arrays and 4x4 matrices: vertices and joints."""
    Rs = Rotation.from_rotvec(pose).as_matrix()
    shaped = model.template + np.einsum("vxs,s->vx", model.shape_directions, shape)
    joints = model.joint_regressor.toarray() @ shaped
    features = (Rs[1:] - np.eye(3)).reshape(-1)
    rest = shaped + np.einsum("vxn,n->vx", model.pose_directions, features)
    Gs = np.zeros((model.num_bones, 4, 4))
    for bone, parent in enumerate(model.parents):
        local = np.eye(4)
        local[:3, :3] = Rs[bone]
        local[:3, 3] = joints[bone] - (joints[parent] if parent >= 0 else 0.0)
        Gs[bone] = local if parent < 0 else Gs[parent] @ local
    posed = Gs[:, :3, 3] + translation
    Gs[:, :3, 3] -= np.einsum("bij,bj->bi", Gs[:, :3, :3], joints)
    T = np.einsum("vb,bij->vij", model.skinning_weights, Gs)
    return np.einsum("vij,vj->vi", T[:, :3, :3], rest) + T[:, :3, 3] + translation, posed


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_vertices_and_joints_are_those_of_the_equations(seed):
    model = random_blend(seed % 3)
    pose, shape, translation = random_pose(model, seed)
    posed = model.pose_at(pose, shape, translation)
    vertices, joints = plain_pose(model, pose, shape, translation)
    np.testing.assert_allclose(posed.vertices, vertices, atol=1e-12)
    np.testing.assert_allclose(posed.joints, joints, atol=1e-12)


def test_the_zero_pose_is_the_template():
    model = random_blend()
    posed = model.pose_at()
    np.testing.assert_allclose(posed.vertices, model.template, atol=1e-15)
    np.testing.assert_allclose(posed.rest, model.template, atol=1e-15)


def test_the_root_turns_about_its_joint_and_not_about_the_origin():
    model = random_blend()
    pose, shape, translation = random_pose(model)
    turn = np.array([0.3, -0.8, 0.4])
    unturned = pose.copy()
    unturned[0] = 0.0
    turned = unturned.copy()
    turned[0] = turn
    root = model.joints_of(model.shaped(shape))[0]
    expected = (model.pose_at(unturned, shape).vertices - root) @ Rotation.from_rotvec(turn).as_matrix().T
    np.testing.assert_allclose(
        model.pose_at(turned, shape, translation).vertices, expected + root + translation, atol=1e-12
    )


def test_joints_are_regressed_from_the_unposed_surface():
    model = random_blend()
    pose, shape, translation = random_pose(model)
    posed = model.pose_at(pose, shape, translation)
    np.testing.assert_allclose(posed.joints_rest, model.joint_regressor @ model.shaped(shape), atol=1e-15)
    from_posed = model.joint_regressor @ posed.vertices
    assert np.abs(from_posed - posed.joints).max() > 1e-3


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("is_personal", [False, True])
def test_jacobians_meet_finite_differences_of_retract(seed, is_personal):
    model = random_blend(seed)
    pose, shape, translation = random_pose(model, seed)
    rest = model.shaped(shape) + 0.001 * np.random.default_rng(seed).standard_normal(model.template.shape)
    personal = rest if is_personal else None

    def posed_after(step):
        turned, changed, moved = model.retract(pose, shape, translation, step)
        return model.pose_at(turned, changed, moved, rest=personal)

    posed = model.pose_at(pose, shape, translation, rest=personal)
    vertices = posed.vertex_jacobian()
    count = model.num_parameters - (model.num_shape if is_personal else 0)
    assert vertices.shape == (len(model.template), 3, count)
    for column in range(count):
        step = np.zeros(count)
        step[column] = STEP
        ahead, behind = posed_after(step), posed_after(-step)
        difference = (ahead.vertices - behind.vertices) / (2 * STEP)
        np.testing.assert_allclose(vertices[:, :, column], difference, atol=3e-9, err_msg=str(column))


def test_the_jacobian_of_some_vertices_is_those_rows():
    model = random_blend()
    posed = model.pose_at(*random_pose(model))
    ids = np.array([700, 3, 3, 41])
    np.testing.assert_array_equal(posed.vertex_jacobian(ids), posed.vertex_jacobian()[ids])
    without = posed.vertex_jacobian(ids, with_shape=False)
    np.testing.assert_array_equal(without, posed.vertex_jacobian()[ids][:, :, :51])


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6), size=st.sampled_from([1e-9, 1e-3, 1.0, 3.0]))
def test_retract_multiplies_from_the_left(seed, size):
    model = untrained_hand()
    rng = np.random.default_rng(seed)
    pose, shape, translation = random_pose(model, seed)
    step = size * rng.standard_normal(model.num_parameters)
    turned, changed, moved = model.retract(pose, shape, translation, step)
    turns = np.vstack([step[:3], step[6:51].reshape(-1, 3)])
    expected = Rotation.from_rotvec(turns) * Rotation.from_rotvec(pose)
    np.testing.assert_allclose(Rotation.from_rotvec(turned).as_matrix(), expected.as_matrix(), atol=1e-12)
    assert np.linalg.norm(turned, axis=1).max() <= np.pi + 1e-12
    np.testing.assert_array_equal(changed, shape + step[51:])
    np.testing.assert_array_equal(moved, translation + step[3:6])


@pytest.mark.parametrize("reflection", [MIRROR, np.array([-1.0, 1.0, 1.0])])
def test_the_mirrored_model_shows_the_mirror_image(reflection):
    model = random_blend()
    pose, shape, translation = random_pose(model)
    mirrored = mirror_blend(model, reflection)
    assert mirrored.side == "left"
    posed = mirrored.pose_at(mirror_blend_pose(pose, reflection), shape, translation * reflection)
    np.testing.assert_allclose(
        posed.vertices, model.pose_at(pose, shape, translation).vertices * reflection, atol=1e-12
    )
    coefficients = np.arange(5.0)
    np.testing.assert_allclose(
        mirrored.pose_of(coefficients), mirror_blend_pose(model.pose_of(coefficients), reflection), atol=1e-12
    )


def test_mirroring_twice_gives_the_model_back():
    model = random_blend()
    twice = mirror_blend(mirror_blend(model))
    assert (twice.name, twice.side) == (model.name, model.side)
    for name in ("template", "faces", "shape_directions", "pose_directions", "pose_mean", "pose_components"):
        np.testing.assert_array_equal(getattr(twice, name), getattr(model, name))


def test_coefficients_of_the_pose_space_count_from_the_mean_or_from_the_flat_hand():
    model = random_blend()
    coefficients = np.array([0.3, -0.2, 0.5])
    flat = model.pose_of(coefficients, flat_mean=True)
    np.testing.assert_allclose(flat.ravel(), coefficients @ model.pose_components[:3], atol=1e-15)
    np.testing.assert_allclose(model.pose_of(coefficients) - flat, model.pose_mean.reshape(-1, 3), atol=1e-15)

"""Bones follow their joints as products of rotations do, and skin follows its bones without losing volume."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.synthesis.scans.bones import dual_quaternions, pose_bones, skin

PARENTS = np.array([-1, 0, 1, 1])
DOF_BONES = np.array([0, 1, 1, 1, 2, 3])
IS_ABDUCTION = np.array([False, False, True, False, False, False])
seeds = st.integers(0, 2**32 - 1)


def chain(seed: int):
    """Axes (6, 3) unit, joints (4, 3) and rolls (4, 3) of four bones."""
    rng = np.random.default_rng(seed)
    axes = rng.standard_normal((6, 3))
    return axes / np.linalg.norm(axes, axis=1, keepdims=True), rng.standard_normal((4, 3)), 0.1 * rng.random((4, 3))


def pose(angles: np.ndarray, seed: int, is_rolling: bool = True) -> tuple[np.ndarray, np.ndarray]:
    axes, joints, rolls = chain(seed)
    Ts, turned = np.empty((4, 3, 4)), np.zeros((6, 3))
    pose_bones(Ts, turned, angles, DOF_BONES, IS_ABDUCTION, axes, joints, PARENTS, rolls * is_rolling)
    return Ts, turned


def draw_motions(seed: int, count: int) -> np.ndarray:
    """(B, 3, 4) rigid."""
    rng = np.random.default_rng(seed)
    rotations = Rotation.from_quat(rng.standard_normal((count, 4))).as_matrix()
    return np.concatenate([rotations, rng.standard_normal((count, 3, 1))], axis=2)


def by_dual_quaternions(rest: np.ndarray, motions: np.ndarray, ids: np.ndarray, weights: np.ndarray) -> np.ndarray:
    posed = np.empty_like(rest)
    skin(posed, rest, dual_quaternions(motions), ids, weights)
    return posed


@settings(max_examples=40, deadline=None)
@given(seeds)
def test_bones_are_the_product_of_their_turns_about_their_joints(seed) -> None:
    """A plain twin: spread, then bend, then twist, each about the joint; then all that the parent does."""
    axes, joints, rolls = chain(seed)
    angles = np.random.default_rng([seed, 1]).uniform(-1.5, 1.5, 6)
    Ts, _ = pose(angles, seed)
    whole = [np.eye(4) for _ in PARENTS]
    for bone, parent in enumerate(PARENTS):
        own = np.flatnonzero(bone == DOF_BONES)
        order = [*own[IS_ABDUCTION[own]], *own[~IS_ABDUCTION[own]]]
        R = np.eye(3)
        for dof in order:
            R = R @ Rotation.from_rotvec(angles[dof] * axes[dof]).as_matrix()
        T = np.eye(4)
        T[:3, :3] = R
        T[:3, 3] = joints[bone] - R @ joints[bone] + (1.0 - np.cos(angles[own[0]])) * rolls[bone]
        whole[bone] = whole[parent] @ T if parent >= 0 else T
    assert np.allclose(Ts, np.array(whole)[:, :3], atol=1e-12)


@settings(max_examples=40, deadline=None)
@given(seeds, st.integers(0, 5))
def test_a_point_moves_about_the_turned_axis_of_a_joint(seed, dof) -> None:
    _, joints, _ = chain(seed)
    angles = np.random.default_rng([seed, 2]).uniform(-1.0, 1.0, 6)
    Ts, turned = pose(angles, seed, is_rolling=False)
    point = np.random.default_rng([seed, 3]).standard_normal(3)
    bone, delta = DOF_BONES[dof], 1e-6
    changed = angles.copy()
    changed[dof] += delta
    after = pose(changed, seed, is_rolling=False)[0][bone]
    speed = (after[:, :3] @ point + after[:, 3] - Ts[bone, :, :3] @ point - Ts[bone, :, 3]) / delta
    center = Ts[bone, :, :3] @ joints[bone] + Ts[bone, :, 3]
    arm = Ts[bone, :, :3] @ point + Ts[bone, :, 3] - center
    assert np.abs(speed - np.cross(turned[dof], arm)).max() < 1e-4 * max(1.0, float(np.linalg.norm(arm)))


@settings(max_examples=40, deadline=None)
@given(seeds)
def test_skin_of_one_bone_moves_as_that_bone(seed) -> None:
    rest, motions = np.random.default_rng(seed).standard_normal((9, 3)), draw_motions(seed, 3)
    ids = np.random.default_rng([seed, 1]).integers(0, 3, (9, 1))
    posed = by_dual_quaternions(rest, motions, ids, np.ones((9, 1)))
    own = motions[ids[:, 0]]
    assert np.allclose(posed, np.einsum("nij,nj->ni", own[:, :, :3], rest) + own[:, :, 3], atol=1e-10)


@settings(max_examples=40, deadline=None)
@given(seeds)
def test_skin_between_bones_that_move_alike_is_rigid_whatever_their_shares(seed) -> None:
    rng = np.random.default_rng(seed)
    rest, motions = rng.standard_normal((9, 3)), np.repeat(draw_motions(seed, 1), 3, axis=0)
    weights = rng.dirichlet(np.ones(3), 9)
    posed = by_dual_quaternions(rest, motions, np.tile(np.arange(3), (9, 1)), weights)
    lengths = np.linalg.norm(rest[:, None] - rest, axis=2), np.linalg.norm(posed[:, None] - posed, axis=2)
    assert np.allclose(*lengths, atol=1e-10)


@settings(max_examples=40, deadline=None)
@given(seeds)
def test_skin_does_not_depend_on_where_the_world_is(seed) -> None:
    """Kavan et al. 2007: blending dual quaternions is independent of the coordinates, as linear blending is."""
    rng = np.random.default_rng(seed)
    rest, motions, world = rng.standard_normal((5, 3)), draw_motions(seed, 2), draw_motions(seed + 1, 1)[0]
    ids, weights = np.tile([0, 1], (5, 1)), rng.dirichlet(np.ones(2), 5)
    moved = np.array([world[:, :3] @ M[:, :3] for M in motions])
    places = np.array([world[:, :3] @ M[:, 3] + world[:, 3] for M in motions])
    there = by_dual_quaternions(rest, np.concatenate([moved, places[:, :, None]], axis=2), ids, weights)
    here = by_dual_quaternions(rest, motions, ids, weights)
    assert np.allclose(there, here @ world[:, :3].T + world[:, 3], atol=1e-9)


@pytest.mark.parametrize("degrees", [30.0, 90.0, 150.0])
def test_skin_half_way_along_a_twist_keeps_its_distance_from_the_axis(degrees) -> None:
    """What linear blending does not: the candy wrapper."""
    twisted = np.zeros((2, 3, 4))
    twisted[0, :, :3] = np.eye(3)
    twisted[1, :, :3] = Rotation.from_rotvec([np.radians(degrees), 0.0, 0.0]).as_matrix()
    rest = np.array([[0.3, 0.01, 0.0]])
    posed = by_dual_quaternions(rest, twisted, np.array([[0, 1]]), np.array([[0.5, 0.5]]))
    assert np.linalg.norm(posed[0, 1:]) == pytest.approx(0.01, abs=1e-12)
    assert np.degrees(np.arctan2(posed[0, 2], posed[0, 1])) == pytest.approx(degrees / 2)


def test_half_turns_have_unit_quaternions_about_every_axis() -> None:
    turns = np.zeros((3, 3, 4))
    for axis in range(3):
        turns[axis, :, :3] = Rotation.from_rotvec(np.pi * np.eye(3)[axis]).as_matrix()
    real = dual_quaternions(turns)[:, :4]
    assert np.allclose(np.abs(real[:, 1:]), np.eye(3), atol=1e-9) and np.allclose(real[:, 0], 0.0, atol=1e-9)

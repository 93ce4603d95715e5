"""Blend weights: the best that are local, not negative and sum to one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

from tests.tracker.training.fingers import PARENTS, Fingers, make_fingers, make_tube, make_weights
from tracker.model.skinning import MAX_WEIGHTS, keep_heaviest
from tracker.training.blend_weights import find_weights, fit_blend_weights, solve_nonnegative
from tracker.training.pose_fit import Poses
from tracker.training.rig import Rig


@pytest.fixture(scope="module")
def fingers() -> Fingers:
    return make_fingers(people=2, poses=10)


def fit_to(fingers: Fingers, rig: Rig, stiffness: float) -> np.ndarray:
    poses = Poses(fingers.rotations, fingers.translations, np.zeros(len(fingers.owners)))
    return fit_blend_weights(poses, fingers.targets, fingers.templates, fingers.owners, fingers.joints, rig, stiffness)


@pytest.mark.parametrize("seed", range(8))
def test_nonnegative_least_squares_agree_with_scipy(seed):
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(30, 12)), rng.normal(size=30)
    np.testing.assert_allclose(solve_nonnegative(A.T @ A, A.T @ b), nnls(A, b)[0], atol=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_weights_are_the_best_of_all_that_sum_to_one(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(9, 6))
    G, allowed = A.T @ A, np.array([1, 1, 0, 1, 1, 1], dtype=bool)
    best = find_weights(G, allowed)
    assert best.sum() == pytest.approx(1.0) and (best >= 0).all() and best[2] == 0.0
    others = rng.dirichlet(np.full(5, 0.5), 2000)
    full = np.zeros((2000, 6))
    full[:, allowed] = others
    assert best @ G @ best <= np.einsum("ni,ij,nj->n", full, G, full).min() + 1e-9


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.integers(1, 9))
def test_what_is_found_meets_the_conditions_of_the_minimum(seed, size):
    """u >= 0, no gradient where u is free, and none that would let a zero grow."""
    rng = np.random.default_rng(seed)
    A, c = rng.normal(size=(size + 2, size)), rng.normal(size=size)
    G = A.T @ A + 1e-3 * np.eye(size)
    u = solve_nonnegative(G, c)
    gradient = c - G @ u
    assert (u >= 0.0).all()
    assert np.abs(gradient[u > 0.0]).max(initial=0.0) < 1e-8 * np.abs(c).max()
    assert gradient.max() < 1e-8 * np.abs(c).max()


def test_when_nothing_pulls_upwards_nothing_is_what_is_found():
    assert not solve_nonnegative(np.eye(3), np.array([-1.0, -2.0, 0.0])).any()


def test_the_only_bone_that_is_allowed_gets_all_and_equal_ones_share_evenly():
    G = np.random.default_rng(1).normal(size=(4, 4))
    np.testing.assert_allclose(find_weights(G @ G.T, np.array([False, True, False, False])), [0.0, 1.0, 0.0, 0.0])
    even = find_weights(np.zeros((4, 4)), np.array([True, True, False, True]))
    np.testing.assert_allclose(even, [1 / 3, 1 / 3, 0.0, 1 / 3])


def test_weights_do_not_depend_on_the_unit_of_distance():
    A = np.random.default_rng(2).normal(size=(9, 5))
    everything = np.ones(5, dtype=bool)
    np.testing.assert_allclose(find_weights(1e6 * A.T @ A, everything), find_weights(A.T @ A, everything), atol=1e-9)


def test_the_weights_that_made_the_registrations_are_found_again(fingers):
    crude = keep_heaviest(make_weights(make_tube()[0][:, 0], 0.003))
    assert np.abs(crude - fingers.weights).max() > 0.2
    found = fit_to(fingers, Rig(PARENTS, crude, fingers.directions), 0.0)
    np.testing.assert_allclose(found, fingers.weights, atol=1e-4)


def test_stiff_weights_stay_and_softer_ones_go_farther(fingers):
    crude = keep_heaviest(make_weights(make_tube()[0][:, 0], 0.003))
    rig = Rig(PARENTS, crude, fingers.directions)
    moved = [np.abs(fit_to(fingers, rig, stiffness) - crude).sum() for stiffness in (1e9, 1.0, 1e-3)]
    assert moved[0] < 1e-4 * moved[1] and moved[1] < moved[2]


def test_whatever_is_registered_a_vertex_follows_its_bone_and_neighbours_in_the_skeleton_only(fingers):
    """A hub of six bones, and registrations that are noise, so that as many bones as may would help."""
    rng = np.random.default_rng(3)
    parents = np.array([-1, 0, 0, 0, 0, 0, 1])
    V, N, B = 40, 12, len(parents)
    so_far = keep_heaviest(rng.dirichlet(np.full(B, 0.3), V))
    templates, joints = rng.normal(size=(1, V, 3)), rng.normal(size=(1, B, 3))
    turns = np.linalg.qr(rng.normal(size=(N, B, 3, 3)))[0]
    turns *= np.linalg.det(turns)[..., None, None]
    poses = Poses(turns, np.zeros((N, 3)), np.zeros(N))
    targets = rng.normal(size=(N, V, 3))
    rig = Rig(parents, so_far, np.zeros((V, 3, 0)))
    weights = fit_blend_weights(poses, targets, templates, np.zeros(N, dtype=np.int64), joints, rig, 1e-9)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)
    assert (weights >= 0.0).all()
    assert np.count_nonzero(weights, axis=1).max() == MAX_WEIGHTS
    for own, used in zip(so_far.argmax(axis=1), weights > 0.0, strict=True):
        near = {own, parents[own], *np.flatnonzero(parents == own)}
        assert set(np.flatnonzero(used)) <= near

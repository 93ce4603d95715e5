"""The sums per pair of bones: they are those of the Jacobian that is never built."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.terms.surface_picks import pick_directions, pick_points, tube_and_ball
from tracker.terms.normal_equations import MAX_BONES, NormalEquations, add_row, gather_bones


@pytest.fixture
def posed(rng):
    return tube_and_ball(rng)


def gather(posed, ids, shares):
    """Bones and sums of a surface point, as many as it has."""
    arrays = posed.scene.arrays
    bones, sums = np.full(MAX_BONES, 99, dtype=np.int32), np.full((MAX_BONES, 4), np.nan)
    count = gather_bones(bones, sums, ids, shares, arrays.weight_bones, arrays.weights, posed.bone_vertices)
    return bones[:count], sums[:count]


def add_plainly(posed, ids, shares, normals, residuals, weights):
    """JᵀJ, Jᵀr by the Jacobian of the vertices, built."""
    moves = posed.vertex_jacobian(ids.ravel()).reshape(len(ids), 3, 3, -1)
    J = np.einsum("nc,ni,ncid->nd", shares, normals, moves)
    return J.T @ (weights[:, None] * J), J.T @ (weights * residuals)


def add_fast(posed, ids, shares, normals, residuals, weights) -> NormalEquations:
    equations = NormalEquations.at(posed)
    arrays = posed.scene.arrays
    bones, sums = np.zeros(MAX_BONES, dtype=np.int32), np.zeros((MAX_BONES, 4))
    wrenches = np.zeros((MAX_BONES, 6))
    for n in range(len(ids)):
        count = gather_bones(bones, sums, ids[n], shares[n], arrays.weight_bones, arrays.weights, posed.bone_vertices)
        add_row(
            equations.blocks, equations.gradients, equations.pair_index, bones, sums, count, wrenches,
            tuple(normals[n]), residuals[n], weights[n],
        )  # fmt: skip
    return equations


def draw_rows(posed, count, rng):
    ids, shares = pick_points(posed, count, rng)
    return ids, shares, pick_directions(count, rng), rng.normal(size=count), rng.uniform(0.1, 3.0, count)


def test_the_bones_of_a_point_share_it_out_and_carry_it_together(posed, rng):
    ids, shares = pick_points(posed, 40, rng)
    for corners, own in zip(ids, shares, strict=True):
        bones, sums = gather(posed, corners, own)
        assert len(set(bones.tolist())) == len(bones) <= MAX_BONES
        assert sums[:, 0].sum() == pytest.approx(1.0)
        np.testing.assert_allclose(sums[:, 1:].sum(axis=0), own @ posed.vertices[corners], atol=1e-14)


def test_a_corner_without_a_share_brings_no_bones(posed):
    ends = np.array([0, len(posed.scene.models[0].vertices) - 1, 5], dtype=np.int32)
    alone, _ = gather(posed, ends[[0, 0, 0]], np.array([1.0, 0.0, 0.0]))
    with_far_end, _ = gather(posed, ends, np.array([1.0, 0.0, 0.0]))
    both, _ = gather(posed, ends, np.array([0.5, 0.5, 0.0]))
    assert set(alone) == set(with_far_end) < set(both)


def test_rows_add_up_as_the_jacobian_has_them(posed, rng):
    rows = draw_rows(posed, 60, rng)
    JtJ, Jtr = add_fast(posed, *rows).assemble()
    plain_JtJ, plain_Jtr = add_plainly(posed, *rows)
    np.testing.assert_allclose(JtJ, plain_JtJ, atol=1e-10 * np.abs(plain_JtJ).max())
    np.testing.assert_allclose(Jtr, plain_Jtr, atol=1e-10 * np.abs(plain_JtJ).max())


def test_the_matrix_is_symmetric_and_never_negative(posed, rng):
    JtJ, _ = add_fast(posed, *draw_rows(posed, 5, rng)).assemble()
    np.testing.assert_allclose(JtJ, JtJ.T, atol=1e-12 * np.abs(JtJ).max())
    values = np.linalg.eigvalsh(JtJ)
    assert values.min() > -1e-9 * values.max()
    assert np.count_nonzero(values > 1e-9 * values.max()) == 5, "each row adds one to the rank"


def test_two_models_that_share_no_point_are_not_coupled(posed, rng):
    rows = draw_rows(posed, 60, rng)
    of_tube, of_ball = posed.scene.pose_slices
    assert set(posed.scene.vertex_models[rows[0]].ravel()) == {0, 1}
    JtJ, _ = add_fast(posed, *rows).assemble()
    assert not JtJ[of_tube, of_ball].any() and not JtJ[of_ball, of_tube].any()


def test_a_point_on_the_root_alone_leaves_the_joints_out(posed, rng):
    weights, bones = posed.scene.arrays.weights, posed.scene.arrays.weight_bones
    vertex = np.int32(np.flatnonzero((weights[:, 0] == 1.0) & (bones[:, 0] == 0))[0])
    rows = np.full((1, 3), vertex), np.array([[1.0, 0.0, 0.0]]), pick_directions(1, rng), np.ones(1), np.ones(1)
    JtJ, Jtr = add_fast(posed, *rows).assemble()
    moved = np.flatnonzero(JtJ.any(axis=0))
    assert set(moved) == set(np.flatnonzero(Jtr)) == set(range(6))


def test_an_empty_sum_is_zero_and_sums_add(posed, rng):
    empty = NormalEquations.at(posed)
    JtJ, Jtr = empty.assemble()
    assert JtJ.shape == (posed.scene.num_dofs,) * 2 and not JtJ.any() and not Jtr.any()
    rows = draw_rows(posed, 20, rng)
    parts = slice(20), slice(8), slice(8, 20)
    whole, first, second = (add_fast(posed, *(each[part] for each in rows)) for part in parts)
    first.cost, first.count, second.cost, second.count = 2.0, 8, 3.0, 12
    second_before = second.blocks.copy()
    first.add(second)
    assert (first.cost, first.count) == (5.0, 20)
    np.testing.assert_array_equal(second.blocks, second_before)
    for found, expected in zip(first.assemble(), whole.assemble(), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())


def test_sums_of_different_poses_do_not_add(posed):
    elsewhere = NormalEquations.at(posed.scene.pose_at(posed.pose + 0.01))
    with pytest.raises(AssertionError):
        NormalEquations.at(posed).add(elsewhere)

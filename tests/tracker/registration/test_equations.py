"""Rows of distances to a mesh are added as plain NumPy adds them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.training.fingers import make_tube
from tracker.registration.equations import add_model_rows, add_surface_rows, weigh_robustly
from tracker.solver.block_cholesky import find_block, find_block_pattern


def test_rows_add_up_as_plain_numpy_adds_them():
    rng = np.random.default_rng(2)
    J, corners = rng.normal(size=(20, 3, 9)), rng.integers(0, 20, (50, 3)).astype(np.int32)
    shares, directions = rng.dirichlet([1, 1, 1], 50), rng.normal(size=(50, 3))
    residuals, weights = rng.normal(size=50), rng.uniform(size=50)
    JtJ, Jtr = np.zeros((9, 9)), np.zeros(9)
    add_model_rows(JtJ, Jtr, J, corners, shares, directions, residuals, weights)
    rows = np.einsum("nd,nk,nkdp->np", directions, shares, J[corners])
    assert np.tril(JtJ) == pytest.approx(np.tril(rows.T @ (weights[:, None] * rows)))
    assert Jtr == pytest.approx(rows.T @ (weights * residuals))


def test_geman_mcclure_weights_are_the_derivative_of_its_cost():
    r = np.linspace(-0.03, 0.03, 41)
    weights, step = np.empty(41), 1e-7
    weigh_robustly(weights, r, 0.005)
    for value, weight in zip(r, weights, strict=True):
        ahead, behind = (weigh_robustly(np.empty(1), np.array([value + s]), 0.005) for s in (step, -step))
        assert (ahead - behind) / (2 * step) == pytest.approx(2.0 * weight * value, rel=1e-5, abs=1e-9)


@given(st.floats(1e-4, 0.1), st.floats(-1.0, 1.0))
def test_the_robust_cost_is_a_square_near_by_and_never_more_than_sigma_squared(sigma, offset):
    weights = np.empty(1)
    total = weigh_robustly(weights, np.array([offset]), sigma)
    assert 0.0 <= total <= min(offset**2, sigma**2)
    assert 0.0 < weights[0] <= 1.0
    assert total == pytest.approx(offset**2 * np.sqrt(weights[0]), abs=1e-15)


def test_robust_costs_add_up_and_none_of_nothing():
    offsets, together = np.array([0.001, -0.004, 0.1]), np.empty(3)
    total = weigh_robustly(together, offsets, 0.004)
    alone = [weigh_robustly(np.empty(1), offsets[[n]], 0.004) for n in range(3)]
    assert total == pytest.approx(sum(alone))
    assert together[1] == 0.25, "at sigma a row has a quarter of its weight"
    assert weigh_robustly(np.empty(0), np.empty(0), 0.004) == 0.0


def test_rows_of_weight_nothing_are_left_out_whatever_they_name():
    rng = np.random.default_rng(3)
    J, shares, directions = rng.normal(size=(5, 3, 4)), rng.dirichlet([1, 1, 1], 2), rng.normal(size=(2, 3))
    JtJ, Jtr = np.zeros((4, 4)), np.zeros(4)
    add_model_rows(JtJ, Jtr, J, np.full((2, 3), -1, np.int32), shares, directions, np.full(2, np.nan), np.zeros(2))
    assert not JtJ.any() and not Jtr.any()


def test_only_the_lower_triangle_is_kept_and_what_was_there_stays():
    rng = np.random.default_rng(4)
    J, corners = rng.normal(size=(6, 3, 4)), rng.integers(0, 6, (9, 3)).astype(np.int32)
    rows = corners, rng.dirichlet([1, 1, 1], 9), rng.normal(size=(9, 3)), rng.normal(size=9), rng.uniform(size=9)
    empty, begun = (np.zeros((4, 4)), np.zeros(4)), (np.full((4, 4), 7.0), np.full(4, 7.0))
    for sums in (empty, begun):
        add_model_rows(*sums, J, *rows)
    assert not np.triu(empty[0], 1).any() and (np.triu(begun[0], 1)[np.triu_indices(4, 1)] == 7.0).all()
    assert np.tril(begun[0] - 7.0) == pytest.approx(empty[0])
    assert begun[1] - 7.0 == pytest.approx(empty[1])


def test_surface_rows_are_the_blocks_of_the_dense_matrix_of_free_vertices():
    """The rows of points on a tube, by blocks and with every unknown in one dense matrix."""
    rng = np.random.default_rng(5)
    vertices, faces = make_tube()
    V, N = len(vertices), 80
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    pattern = find_block_pattern(V, edges)
    pairs = [(k, k) for k in range(3)] + [(k, (k + 1) % 3) for k in range(3)]
    places = np.stack([find_block(pattern, faces[:, a], faces[:, b])[0] for a, b in pairs], axis=1)
    found = rng.integers(-1, len(faces), N).astype(np.int32)
    found[:3] = -1
    shares, directions = rng.dirichlet([1, 1, 1], N), rng.normal(size=(N, 3))
    residuals, weights = rng.normal(size=N), rng.uniform(size=N) * (rng.random(N) < 0.8)
    blocks, right = np.zeros((len(pattern.rows), 3, 3)), np.zeros((V, 3))
    add_surface_rows(blocks, right, places, faces, found, shares, directions, residuals, weights)

    rows = np.zeros((N, V, 3))
    for n in np.flatnonzero(found >= 0):
        rows[n, faces[found[n]]] += shares[n, :, None] * directions[n]
    flat = rows.reshape(N, -1)
    dense = (flat.T @ (weights[:, None] * flat)).reshape(V, 3, V, 3).transpose(0, 2, 1, 3)
    np.testing.assert_allclose(right.ravel(), flat.T @ (weights * residuals), atol=1e-12)
    nodes = np.arange(V)
    np.testing.assert_allclose(blocks[find_block(pattern, nodes, nodes)[0]], dense[nodes, nodes], atol=1e-12)
    np.testing.assert_allclose(
        blocks[find_block(pattern, edges[:, 0], edges[:, 1])[0]], dense[edges[:, 0], edges[:, 1]], atol=1e-12
    )

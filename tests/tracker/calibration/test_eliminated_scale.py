"""Boards eliminated or not, the factor is the normal matrix's own."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csr_array

from tracker.calibration.eliminated_scale import EliminatedScale


def bundle(rng: np.random.Generator, boards: int, cameras: int) -> np.ndarray:
    """A Jacobian (R, n) whose rows touch one board each."""
    rows = []
    for board in range(boards):
        block = np.zeros((20, 6 * boards + cameras))
        block[:, 6 * board : 6 * board + 6] = rng.normal(size=(20, 6))
        block[:, 6 * boards :] = rng.normal(size=(20, cameras))
        rows.append(block)
    return np.concatenate([*rows, np.hstack([np.zeros((20, 6 * boards)), rng.normal(size=(20, cameras))])])


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(0, 4), st.integers(0, 5))
def test_scaling_is_dividing_by_the_dense_cholesky_factor(seed: int, boards: int, cameras: int) -> None:
    rng = np.random.default_rng(seed)
    J = bundle(rng, boards, cameras)
    scale = EliminatedScale(csr_array(J), 6 * boards)
    L = cholesky(J.T @ J, lower=True) if J.shape[1] else np.zeros((0, 0))
    x, y = rng.normal(size=(2, J.shape[1]))
    if len(x):
        assert np.allclose(scale.apply(y), solve_triangular(L, y, lower=True, trans=1), rtol=1e-5, atol=1e-6)
        assert np.allclose(scale.apply_transposed(x), solve_triangular(L, x, lower=True), rtol=1e-5, atol=1e-6)
    assert np.allclose(scale.factor, L[6 * boards :, 6 * boards :], rtol=1e-5, atol=1e-6)


def test_the_composed_jacobian_and_its_transpose_are_the_dense_products(rng: np.random.Generator) -> None:
    J = bundle(rng, 3, 4)
    scale = EliminatedScale(csr_array(J), 18)
    y, r = rng.normal(size=J.shape[1]), rng.normal(size=J.shape[0])
    composed = scale.compose(csr_array(J))
    assert np.allclose(composed.matvec(y), J @ scale.apply(y))
    assert np.allclose(composed.rmatvec(r), scale.apply_transposed(J.T @ r))
    assert composed.matvec(y) @ r == pytest.approx(y @ composed.rmatvec(r))


@pytest.mark.parametrize("column", [2, 13])
def test_what_no_residual_depends_on_stays_finite_and_moves_nothing(rng: np.random.Generator, column: int) -> None:
    J = bundle(rng, 2, 3)
    J[:, column] = 0.0
    scale = EliminatedScale(csr_array(J), 12)
    step = scale.apply(rng.normal(size=15))
    assert np.isfinite(step).all() and np.isfinite(scale.apply_transposed(step)).all()
    others = np.delete(np.eye(15), column, axis=0)
    columns = J @ np.array([scale.apply(unit) for unit in others]).T
    assert np.allclose(columns.T @ columns, np.eye(14), atol=1e-5), "the others as if it were not there"

"""The sparse factor against dense algebra."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.errors import SolveError
from tracker.solver.block_cholesky import factorize, find_block, find_block_pattern, solve_lower, solve_upper


def make_system(seed: int, nodes: int = 40, extra: int = 60):
    """A positive definite matrix of 3 x 3 blocks on a random connected graph."""
    rng = np.random.default_rng(seed)
    chain = np.stack([np.arange(nodes - 1), np.arange(1, nodes)], axis=1)
    others = rng.integers(0, nodes, (extra, 2))
    edges = np.unique(np.sort(np.concatenate([chain, others[others[:, 0] != others[:, 1]]]), axis=1), axis=0)
    A = 0.01 * np.eye(3 * nodes)
    for a, b in edges:
        row = np.zeros((3, 3 * nodes))
        row[:, 3 * a : 3 * a + 3], row[:, 3 * b : 3 * b + 3] = rng.standard_normal((2, 3, 3))
        A += row.T @ row
    pattern = find_block_pattern(nodes, edges)
    blocks = np.zeros((len(pattern.rows), 3, 3))
    pairs = np.concatenate([edges, np.repeat(np.arange(nodes)[:, None], 2, axis=1)])
    places, is_turned = find_block(pattern, pairs[:, 0], pairs[:, 1])
    for (a, b), place, turned in zip(pairs, places, is_turned, strict=True):
        block = A[3 * a : 3 * a + 3, 3 * b : 3 * b + 3]
        blocks[place] = block.T if turned else block
    return A, pattern, blocks, rng


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_solving_with_the_factor_gives_what_dense_algebra_gives(seed):
    A, pattern, blocks, rng = make_system(seed)
    right = rng.standard_normal((len(pattern.order), 3))
    factor = factorize(pattern, blocks)
    half = solve_lower(pattern, factor, right[pattern.order][:, :, None])[:, :, 0]
    solution = np.empty_like(right)
    solution[pattern.order] = solve_upper(pattern, factor, half)
    assert solution.ravel() == pytest.approx(np.linalg.solve(A, right.ravel()), rel=1e-8, abs=1e-10)


def test_the_half_solved_right_sides_give_the_schur_complement():
    A, pattern, blocks, rng = make_system(4)
    B = rng.standard_normal((len(pattern.order), 3, 7))
    Y = solve_lower(pattern, factorize(pattern, blocks), B[pattern.order]).reshape(-1, 7)
    flat = B.reshape(-1, 7)
    schur = flat.T @ np.linalg.solve(A, flat)
    assert np.allclose(Y.T @ Y, schur, rtol=1e-8)


def test_the_order_fills_in_little():
    _, pattern, _, _ = make_system(5, nodes=200, extra=20)
    assert len(pattern.rows) < 4 * 200


def test_an_indefinite_matrix_is_refused():
    _, pattern, blocks, _ = make_system(6)
    with pytest.raises(SolveError, match="no minimum"):
        factorize(pattern, -blocks)

"""Shared parameters are found as if every problem's own had been solved along with them."""

import numpy as np
import pytest

from tracker.errors import SolveError
from tracker.solver.elimination import add_shared_rows, solve_definite, subtract_product


def test_eliminating_gives_the_step_of_the_whole_system(rng):
    M, N, S = 60, 5, 7
    J_o, J_s = rng.normal(size=(M, N)), rng.normal(size=(M, S))
    J_s[rng.random((M, S)) < 0.6] = 0.0
    r, w = rng.normal(size=M), rng.uniform(0.1, 2.0, M)
    A_ss, A_os, b_s = np.zeros((S, S)), np.zeros((N, S)), np.zeros(S)
    add_shared_rows(A_ss, A_os, b_s, J_s, J_o, r, w)
    A_ss += np.tril(A_ss, -1).T
    eliminated = solve_definite(J_o.T @ (w[:, None] * J_o), np.column_stack([A_os, -J_o.T @ (w * r)]))
    follow, settle = np.ascontiguousarray(eliminated[:, :-1]), eliminated[:, -1]
    subtract_product(A_ss, A_os, follow)
    shared = np.linalg.solve(A_ss, -(b_s + settle @ A_os))
    J = np.concatenate([J_o, J_s], axis=1)
    whole = np.linalg.solve(J.T @ (w[:, None] * J), -J.T @ (w * r))
    np.testing.assert_allclose(settle - follow @ shared, whole[:N], atol=1e-10)
    np.testing.assert_allclose(shared, whole[N:], atol=1e-10)


def test_equations_without_a_minimum_are_refused():
    with pytest.raises(SolveError, match="no minimum"):
        solve_definite(np.diag([1.0, -1.0]), np.ones((2, 1)))

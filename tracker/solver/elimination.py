"""Normal equations of parameters that many problems share, with each problem's own parameters eliminated."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.errors import SolveError

Array = npt.NDArray[np.float64]


@njit(cache=True, nogil=True)
def add_shared_rows(A_ss, A_os, b_s, J_s, J_o, residual, weights):
    """Add rows of a residual to the equations of the shared parameters; only the lower triangle of A_ss is kept.

    Most entries of a row are zero, and written out this does not wait for threads of a linear-algebra library.

    Args:
        A_ss: (S, S) sum of w J_s' J_s.
        A_os: (O, S) sum of w J_o' J_s.
        b_s: (S,) sum of w J_s' r.
        J_s: (M, S) derivative by the shared parameters.
        J_o: (M, O) derivative by the problem's own.
        residual: (M,).
        weights: (M,).
    """
    shared = np.empty(J_s.shape[1], dtype=np.int64)
    own = np.empty(J_o.shape[1], dtype=np.int64)
    for row in range(len(residual)):
        count = 0
        for s in range(J_s.shape[1]):
            if J_s[row, s] != 0.0:
                shared[count] = s
                count += 1
        num_own = 0
        for o in range(J_o.shape[1]):
            if J_o[row, o] != 0.0:
                own[num_own] = o
                num_own += 1
        for i in range(count):
            s = shared[i]
            weighted = weights[row] * J_s[row, s]
            b_s[s] += weighted * residual[row]
            for j in range(i + 1):
                A_ss[s, shared[j]] += weighted * J_s[row, shared[j]]
            for k in range(num_own):
                A_os[own[k], s] += weighted * J_o[row, own[k]]


def solve_definite(A: Array, B: Array) -> Array:
    """A⁻¹ B for a positive definite A (N, N) and B (N, K).

    Raises:
        SolveError: A is not positive definite.
    """
    solution = B.copy()
    if not _solve_in_place(A.copy(), solution):
        raise SolveError("The equations have no minimum; needed depth of a hand in every frame.")
    return solution


@njit(cache=True, nogil=True)
def subtract_product(A, B, C):
    """A (S, S) −= B' C for B and C (O, S)."""
    for k in range(len(B)):
        for i in range(len(A)):
            if B[k, i] != 0.0:
                A[i] -= B[k, i] * C[k]


@njit(cache=True, nogil=True)
def _solve_in_place(A, B):
    """B becomes A⁻¹ B by a Cholesky factor that overwrites A; False if A is not positive definite."""
    size = len(A)
    for i in range(size):
        for j in range(i + 1):
            total = A[i, j]
            for k in range(j):
                total -= A[i, k] * A[j, k]
            if i > j:
                A[i, j] = total / A[j, j]
            elif total > 0.0:
                A[i, i] = np.sqrt(total)
            else:
                return False
    for i in range(size):
        for k in range(i):
            B[i] -= A[i, k] * B[k]
        B[i] /= A[i, i]
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, size):
            B[i] -= A[k, i] * B[k]
        B[i] /= A[i, i]
    return True

"""One damped Gauss-Newton step on normal equations."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.errors import SolveError

Array = npt.NDArray[np.float64]

FLOOR = 1e-9
"""Share of the largest diagonal entry that is added to all, so that what nothing observes stays where it is."""


def compute_damped_step(JtJ: Array, Jtr: Array, damping: float, limits: Array) -> Array:
    """The step that minimises the linearised cost, Levenberg-Marquardt damped, then shortened as a whole to its limits.

    Args:
        JtJ: (D, D) positive semi-definite.
        Jtr: (D,).
        damping: Added share of the diagonal.
        limits: (D,) largest allowed absolute change of each parameter.

    Raises:
        SolveError: The equations are not finite.
    """
    if not (np.isfinite(JtJ).all() and np.isfinite(Jtr).all()):
        raise SolveError("The objective is not finite; needed finite depth, calibration and models.")
    diagonal = np.diagonal(JtJ)
    largest = max(float(diagonal.max(initial=0.0)), 1e-12)
    step = np.empty(len(Jtr))
    floor = FLOOR
    while not _solve_into(step, JtJ, Jtr, damping * diagonal + floor * largest):
        floor *= 1e3  # rounding made a semi-definite matrix indefinite
        if floor > 1.0:
            raise SolveError("The objective has no minimum that can be found.")
    longest = float(np.max(np.abs(step) / limits))
    return step / longest if longest > 1.0 else step


@njit(cache=True, nogil=True, fastmath={"reassoc"})
def _solve_into(step, JtJ, Jtr, added):
    """Solve (JtJ + diag(added)) step = -Jtr by a Cholesky factor; False if the matrix is not positive definite.

    Written out because LAPACK shares so small a matrix among threads, which on a busy machine wait for one another, and
    because the order of its sums, and so the last bit of a track, would depend on their number.
    """
    size = len(Jtr)
    L = np.empty((size, size))
    for i in range(size):
        for j in range(i + 1):
            total = JtJ[i, j]
            if i == j:
                total += added[i]
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i > j:
                L[i, j] = total / L[j, j]
            elif total > 0.0:
                L[i, i] = np.sqrt(total)
            else:
                return False
    for i in range(size):
        total = -Jtr[i]
        for k in range(i):
            total -= L[i, k] * step[k]
        step[i] = total / L[i, i]
    for i in range(size - 1, -1, -1):
        total = step[i]
        for k in range(i + 1, size):
            total -= L[k, i] * step[k]
        step[i] = total / L[i, i]
    return True

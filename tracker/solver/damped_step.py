"""One damped Gauss-Newton step on normal equations."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.linalg

Array = npt.NDArray[np.float64]


def compute_damped_step(JtJ: Array, Jtr: Array, damping: float, limits: Array) -> Array:
    """The step that minimises the linearised cost, Levenberg-Marquardt damped, then shortened as a whole to its limits.

    Args:
        JtJ: (D, D) positive semi-definite.
        Jtr: (D,).
        damping: Added share of the diagonal.
        limits: (D,) largest allowed absolute change of each parameter.
    """
    diagonal = np.diagonal(JtJ)
    A = JtJ.copy()
    A[np.diag_indices_from(A)] += damping * diagonal + 1e-9 * max(float(diagonal.max(initial=0.0)), 1e-12)
    step = -scipy.linalg.cho_solve(scipy.linalg.cho_factor(A, overwrite_a=True, check_finite=False), Jtr)
    longest = float(np.max(np.abs(step) / limits))
    return step / longest if longest > 1.0 else step

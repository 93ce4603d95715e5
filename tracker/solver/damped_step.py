"""One damped Gauss-Newton step on normal equations."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import LinAlgError, cho_factor, cho_solve

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
    floor = FLOOR
    while True:
        A = JtJ.copy()
        A[np.diag_indices_from(A)] += damping * diagonal + floor * largest
        try:
            factor = cho_factor(A, overwrite_a=True, check_finite=False)
            step = np.asarray(-cho_solve(factor, Jtr, check_finite=False), dtype=np.float64)
            break
        except LinAlgError:  # rounding made a semi-definite matrix indefinite
            floor *= 1e3
            if floor > 1.0:
                raise SolveError("The objective has no minimum that can be found.") from None
    longest = float(np.max(np.abs(step) / limits))
    return step / longest if longest > 1.0 else step

"""A model's pose and shape from a registered mesh: every vertex knows where it belongs."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve

from tracker.geometry.se3 import find_rotations
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import MM, ModelFit

Array = npt.NDArray[np.float64]


def fit_to_vertices(fit: ModelFit, state: HandState, vertices: Array, weight: float = 0.05) -> HandState:
    """The state whose vertices lie nearest to `vertices` (V, 3), m; the same hand if they are of another topology.

    Args:
        fit: The model and its prior.
        state: Where to begin; its root is laid onto the vertices first.
        vertices: (V, 3) right hand, m.
        weight: Of pose prior and shape prior.
    """
    model = fit.model
    if vertices.shape != model.template.shape:
        return state
    state = _align(fit, state, vertices)
    for _ in range(6):
        posed = state.posed(model)
        J = posed.vertex_jacobian().reshape(-1, model.num_parameters) * (fit.scales * MM)
        residual = (posed.vertices - vertices).ravel() * MM
        H, g = J.T @ J, J.T @ residual
        prior_JtJ, prior_Jtr = fit.prior_equations(state, weight, weight)
        H += prior_JtJ * fit.scales[:, None] * fit.scales
        g += prior_Jtr * fit.scales
        H[np.diag_indices_from(H)] *= 1.0 + 1e-6
        step = -cho_solve(cho_factor(H, lower=True), g)
        length = float(np.abs(step).max())
        state = state.retract(model, fit.scales * step * min(1.0, 2.0 / max(length, 1e-9)))
        if length < 1e-3:
            break
    return state


def _align(fit: ModelFit, state: HandState, vertices: Array) -> HandState:
    """The state with its root turned and moved onto the vertices (Kabsch)."""
    own = state.posed(fit.model).vertices
    mine, theirs = own.mean(axis=0), vertices.mean(axis=0)
    R = find_rotations((vertices - theirs).T @ (own - mine))
    return state.moved(fit.model, R, theirs - R @ mine)

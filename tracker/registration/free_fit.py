"""A free surface coupled to the model: Eq. 5-9 of [R17], all unknowns at once, by sparse dogleg."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy import sparse
from scipy.linalg import cho_factor, cho_solve

from tracker.errors import SolveError
from tracker.registration.equations import add_surface_rows
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import MM, ModelFit, weigh_matches
from tracker.registration.scan_points import ScanPoints
from tracker.registration.surface_search import Matches
from tracker.solver.block_cholesky import factorize, find_block, find_block_pattern, solve_lower, solve_upper
from tracker.solver.minimize import TrustRegion, minimize

Array = npt.NDArray[np.float64]

VERTEX_SCALE = 0.01
"""m; what counts as much as 0.3 rad of a joint in the trust region."""

FIRST_RADIUS, LEAST_RADIUS = 20.0, 1e-2
"""Of the trust region."""


@dataclass(frozen=True)
class FreeSettings:
    """One stage of a free fit.

    Attributes:
        coupling: λ_c of [R17] Eq. 5, edges summed, in mm² against a data term of one for each vertex.
        sigma_mm: Scale of the Geman-McClure function.
        iterations: Steps tried at most.
        pose_weight: λ_θ, far below the model fit's, and λ_β likewise: with full priors the model lags behind the
            surface and drags it along the skin (vertices .91 mm off with a learned model, instead of .76).
        shape_weight: λ_β.
        tolerance: Ends when a step brings less than this share of the cost.
    """

    coupling: float
    sigma_mm: float
    iterations: int
    pose_weight: float = 0.1
    shape_weight: float = 0.1
    tolerance: float = 1e-3


@dataclass(frozen=True)
class FreeSurface:
    """Free vertices (V, 3), m, and the model they are coupled to."""

    vertices: Array
    state: HandState
    model_vertices: Array
    matches: Matches
    weights: Array
    cost: float

    @property
    def offset(self) -> Array:
        """(3,) m from the middle of the model to that of the surface, which the coupling of edges leaves free."""
        return (self.vertices - self.model_vertices).mean(axis=0)


class FreeFit:
    """Fits free vertices; what depends on the topology alone is worked out once.

    Args:
        fit: The model and its prior.
    """

    def __init__(self, fit: ModelFit) -> None:
        self.fit_model = fit
        faces = fit.search.faces.astype(np.int64)
        num_vertices = len(fit.model.template)
        corners = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        self.edges = np.unique(np.sort(corners, axis=1), axis=0)
        self.pattern = find_block_pattern(num_vertices, self.edges)
        nodes = np.arange(num_vertices)
        self.places = np.stack(
            [find_block(self.pattern, faces[:, k], faces[:, k])[0] for k in range(3)]
            + [find_block(self.pattern, faces[:, k], faces[:, (k + 1) % 3])[0] for k in range(3)],
            axis=1,
        )
        ones = np.ones(len(self.edges))
        rows = np.arange(len(self.edges))
        D = sparse.csr_matrix((ones, (rows, self.edges[:, 0])), (len(rows), num_vertices))
        self.differences = (D - sparse.csr_matrix((ones, (rows, self.edges[:, 1])), D.shape)).tocsr()
        self.laplacian = (self.differences.T @ self.differences).tocsr()
        blocks = np.zeros((len(self.pattern.rows), 3, 3))
        diagonal = self.laplacian.diagonal()
        blocks[find_block(self.pattern, nodes, nodes)[0]] = diagonal[:, None, None] * np.eye(3)
        blocks[find_block(self.pattern, self.edges[:, 0], self.edges[:, 1])[0]] = -np.eye(3)
        self.coupling_blocks = blocks
        self.diagonal_places = find_block(self.pattern, nodes, nodes)[0]

    def fit(self, start: FreeSurface, scan: ScanPoints, settings: FreeSettings) -> FreeSurface:
        """The best surface that `settings.iterations` dogleg steps find."""

        def move(here: FreeSurface, step: Array) -> FreeSurface:
            turn, moved = self.split(step)
            state = self.fit_model.move(here.state, turn)
            return self.evaluate(here.vertices + moved, state, scan, settings, here.matches)

        region = TrustRegion(FIRST_RADIUS, LEAST_RADIUS, settings.iterations, settings.tolerance)
        here = self.evaluate(start.vertices, start.state, scan, settings, start.matches)
        return minimize(here, lambda surface: self.linearize(surface, settings), move, region)

    def evaluate(
        self, vertices: Array, state: HandState, scan: ScanPoints, settings: FreeSettings, seeds: Matches | None
    ) -> FreeSurface:
        """Matches and cost of free vertices (V, 3) and a model."""
        fit = self.fit_model
        sigma = settings.sigma_mm / MM
        reach = 4.0 * sigma
        known = seeds.faces if seeds is not None and len(seeds.faces) == len(scan.points) else None
        matches = fit.search.match(vertices, scan.points, scan.normals, reach, known)
        weights, total = weigh_matches(matches, reach, sigma)
        scale = len(vertices) / len(scan.points)
        cost = scale * MM * MM * total
        weights *= scale * MM * MM
        model_vertices = fit.pose(state).vertices
        stretch = self.differences @ (vertices - model_vertices) * MM
        cost += settings.coupling * float(np.einsum("ed,ed->", stretch, stretch))
        cost += fit.prior_cost(state, settings.pose_weight, settings.shape_weight)
        return FreeSurface(vertices, state, model_vertices, matches, weights, cost)

    def linearize(self, here: FreeSurface, settings: FreeSettings) -> _System:
        """The normal equations at a surface, solved.

        Raises:
            SolveError: They are not positive definite.
        """
        try:
            return _System(self, here, settings)
        except np.linalg.LinAlgError as error:
            raise SolveError("The model's equations are not positive definite.") from error

    def split(self, step: Array) -> tuple[Array, Array]:
        """Step of the model (P,) and of the vertices (V, 3), no longer scaled."""
        scales = self.fit_model.scales
        return step[: len(scales)] * scales, step[len(scales) :].reshape(-1, 3) * VERTEX_SCALE


class _System:
    """Normal equations of one linearisation; unknowns are scaled, the model's (P,) before the vertices' (3 V,)."""

    def __init__(self, free: FreeFit, here: FreeSurface, settings: FreeSettings) -> None:
        fit = free.fit_model
        self.free, self.here, self.settings = free, here, settings
        num_vertices = len(here.vertices)
        strength = settings.coupling * MM * MM
        J = fit.jacobian(fit.pose(here.state)) * fit.scales
        self.J = J
        apart = here.vertices - here.model_vertices
        pull = strength * (free.laplacian @ apart)
        LJ = (strength * (free.laplacian @ J.reshape(num_vertices, -1))).reshape(J.shape)
        prior_JtJ, prior_Jtr = fit.prior_equations(here.state, settings.pose_weight, settings.shape_weight)
        prior = prior_JtJ * fit.scales[:, None] * fit.scales
        self.prior = prior
        g_model = prior_Jtr * fit.scales - np.einsum("vdp,vd->p", J, pull)
        H_model = J.reshape(-1, J.shape[2]).T @ LJ.reshape(-1, J.shape[2]) + prior
        H_model[np.diag_indices_from(H_model)] += 1e-9 * np.trace(H_model) / len(H_model)
        blocks = strength * free.coupling_blocks
        blocks[free.diagonal_places] += 1e-6 * strength * np.eye(3)
        g_vertices = pull.copy()
        matches = here.matches
        add_surface_rows(
            blocks,
            g_vertices,
            free.places,
            fit.search.faces,
            matches.faces,
            matches.weights,
            matches.directions,
            -matches.offsets,
            here.weights,
        )
        blocks *= VERTEX_SCALE**2
        g_vertices *= VERTEX_SCALE
        factor = factorize(free.pattern, blocks)
        order = free.pattern.order
        right = np.concatenate([-VERTEX_SCALE * LJ, g_vertices[:, :, None]], axis=2)[order]
        reduced = solve_lower(free.pattern, factor, right).reshape(3 * num_vertices, -1)
        Y, y = reduced[:, :-1], reduced[:, -1]
        schur = H_model - Y.T @ Y
        turn = -cho_solve(cho_factor(schur, lower=True, check_finite=False), g_model - Y.T @ y, check_finite=False)
        ordered = solve_upper(free.pattern, factor, -(y + Y @ turn).reshape(-1, 3))
        move = np.empty_like(ordered)
        move[order] = ordered
        self.newton = np.concatenate([turn, move.ravel()])
        self.gradient = np.concatenate([g_model, g_vertices.ravel()])

    def curvature(self, step: Array) -> float:
        """step' H step."""
        size = self.J.shape[2]
        turn, move = step[:size], step[size:].reshape(-1, 3) * VERTEX_SCALE
        matches = self.here.matches
        data = _sum_squares(
            move,
            self.free.fit_model.search.faces,
            matches.faces,
            matches.weights,
            matches.directions,
            self.here.weights,
        )
        stretch = self.free.differences @ (move - self.J @ turn) * MM
        return (
            data
            + self.settings.coupling * float(np.einsum("ed,ed->", stretch, stretch))
            + float(turn @ self.prior @ turn)
        )


@njit(cache=True, nogil=True)
def _sum_squares(move, faces, found, shares, directions, weights):
    total = 0.0
    for n in range(len(weights)):
        f = found[n]
        if weights[n] != 0.0 and f >= 0:
            value = 0.0
            for k in range(3):
                v = faces[f, k]
                along = move[v, 0] * directions[n, 0] + move[v, 1] * directions[n, 1] + move[v, 2] * directions[n, 2]
                value += shares[n, k] * along
            total += weights[n] * value * value
    return total

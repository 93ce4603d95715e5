"""Pose and shape of a model by dogleg on robust distances: Eq. 5 of [R17] with the surface held to the model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.blend_model import BlendModel
from tracker.registration.equations import add_model_rows, weigh_robustly
from tracker.registration.hand_state import HandState
from tracker.registration.pose_prior import PosePrior
from tracker.registration.scan_points import ScanPoints
from tracker.registration.surface_search import MIN_COSINE, Matches, SurfaceSearch
from tracker.solver.minimize import DenseSystem, TrustRegion, minimize

Array = npt.NDArray[np.float64]

MM = 1e3
"""The objective counts in mm."""

FIRST_RADIUS, LEAST_RADIUS = 3.0, 1e-3
"""Of the trust region, in parameters scaled to 0.3 rad of a joint."""


ALL = 100_000
"""More vertices than any model has."""


@dataclass(frozen=True)
class FitSettings:
    """One stage of a fit.

    Attributes:
        sigma_mm: Scale of the Geman-McClure function.
        iterations: Steps tried at most.
        to_scan: Weight of distances from the model's vertices to the scan, against those from the scan to the model.
        pose_weight: λ_θ of [R17] Eq. 5.
        shape_weight: λ_β.
        tolerance: Ends when a step brings less than this share of the cost.
        back: So many vertices at most, evenly spread, look for the scan.
    """

    sigma_mm: float
    iterations: int
    to_scan: float = 0.0
    pose_weight: float = 1.0
    shape_weight: float = 10.0
    tolerance: float = 1e-3
    back: int = ALL


class Posed(Protocol):
    """A surface in a pose."""

    @property
    def vertices(self) -> Array: ...

    def vertex_jacobian(self, vertex_ids: npt.NDArray[np.int64] | None = None) -> Array: ...


@dataclass(frozen=True)
class LookBack:
    """What N vertices see of a scan.

    Attributes:
        is_used: (N,) whether a point that looks the same way is within reach.
        distances: (N,) to the nearest point, m; infinite where none is within reach.
        along: (N,) the same along the point's normal, where it has one.
        normals: (N, 3) unit, of the points; towards the vertex where one has none.
    """

    is_used: npt.NDArray[np.bool_]
    distances: Array
    along: Array
    normals: Array


@dataclass(frozen=True)
class Evaluation:
    """The objective at a state, with all that its linearisation needs."""

    state: HandState
    posed: Posed
    matches: Matches
    weights: Array
    back_weights: Array
    back_offsets: Array
    back_normals: Array
    cost: float


class ModelFit:
    """Fits one model to points.

    Args:
        model: A right hand.
        prior: Of its pose.
    """

    def __init__(self, model: BlendModel, prior: PosePrior) -> None:
        self.model = model
        self.prior = prior
        self.search = SurfaceSearch(model.template, model.faces)
        self.inner = spread(model.template, ~self.search.is_rim_vertex)
        """Vertices off the rim, which look for the scan; any first of them lie evenly spread."""
        K = len(model.parents) - 1
        self.scales = np.concatenate([np.full(3, 0.3), np.full(3, 0.02), np.full(3 * K, 0.3), np.ones(model.num_shape)])

    def neutral(self) -> HandState:
        model = self.model
        pose = np.concatenate([np.zeros((1, 3)), self.prior.mean.reshape(-1, 3)])
        return HandState(pose, np.zeros(model.num_shape), np.zeros(3))

    def fit(self, state: HandState, scan: ScanPoints, settings: FitSettings, seeds=None) -> Evaluation:
        """The best state that `settings.iterations` dogleg steps find."""
        scales = self.scales

        def linearize(here: Evaluation) -> DenseSystem:
            JtJ, Jtr = self.linearize(here, scan, settings)
            return DenseSystem(JtJ * scales[:, None] * scales, Jtr * scales)

        def move(here: Evaluation, step: Array) -> Evaluation:
            return self.evaluate(self.move(here.state, step * scales), scan, settings, here.matches.faces)

        region = TrustRegion(FIRST_RADIUS, LEAST_RADIUS, settings.iterations, settings.tolerance)
        return minimize(self.evaluate(state, scan, settings, seeds), linearize, move, region)

    def evaluate(self, state: HandState, scan: ScanPoints, settings: FitSettings, seeds=None) -> Evaluation:
        """Matches and cost at a state."""
        posed = self.pose(state)
        vertices = posed.vertices
        sigma = settings.sigma_mm / MM
        reach = 4.0 * sigma
        matches = self.search.match(vertices, scan.points, scan.normals, reach, seeds)
        weights, total = weigh_matches(matches, reach, sigma)
        scale = len(vertices) / len(scan.points)
        data = scale * MM * MM * total
        weights *= scale
        back_weights = back_offsets = np.zeros(0)
        back_normals = np.zeros((0, 3))
        if settings.to_scan > 0.0:
            back = self.look_back(vertices, scan, reach, settings.back)
            back_normals, back_offsets = back.normals, np.where(back.is_used, back.along, 0.0)
            # the weight follows the whole distance, so that vertices over a hole do not count as near its rim's plane
            square, distances = sigma * sigma, np.where(back.is_used, back.distances, 0.0)
            share = np.where(back.is_used, square / (square + distances**2), 0.0)
            rho = np.where(back.is_used, distances**2 * share, saturated(reach, sigma))
            strength = settings.to_scan * len(self.inner) / len(rho)
            data += strength * MM * MM * float(rho.sum())
            back_weights = strength * share * share
        cost = data + self.prior_cost(state, settings.pose_weight, settings.shape_weight)
        return Evaluation(state, posed, matches, weights, back_weights, back_offsets, back_normals, cost)

    def look_back(self, vertices: Array, scan: ScanPoints, reach: float, most: int = ALL) -> LookBack:
        """What vertices (V, 3) of the surface off its rim, m, `most` of them evenly spread, see of the scan."""
        inner, surface = self.inner[:most], scan.surface
        distances, ids = surface.tree.query(vertices[inner], distance_upper_bound=reach)
        is_near = np.asarray(ids < len(surface.points))
        ids = np.where(is_near, ids, 0)
        towards, normals = vertices[inner] - surface.points[ids], surface.normals[ids]
        mine = find_unit_normals(vertices, self.search.faces)[inner]
        looks = np.asarray(np.einsum("nd,nd->n", normals, mine) > MIN_COSINE)
        has_normal = np.asarray(normals.any(axis=1))
        along = np.where(has_normal, np.einsum("nd,nd->n", towards, normals), distances)
        ways = np.where(has_normal[:, None], normals, towards / np.maximum(distances, 1e-9)[:, None])
        return LookBack(is_near & (looks | ~has_normal), np.asarray(distances), along, ways)

    def linearize(self, here: Evaluation, scan: ScanPoints, settings: FitSettings) -> tuple[Array, Array]:
        """JtJ (P, P) and Jtr (P,), half the gradient, in the model's order of parameters."""
        matches = here.matches
        corners = self.search.faces[matches.faces]
        is_used = np.zeros(len(here.posed.vertices), dtype=np.bool_)
        is_used[corners[here.weights != 0.0]] = True
        is_used[self.inner[: len(here.back_weights)]] = True
        used = np.flatnonzero(is_used)
        rows = (np.cumsum(is_used) - 1).astype(np.int32)  # of the derivative, by vertex
        J = self.jacobian(here.posed, used)
        size = J.shape[2]
        JtJ, Jtr = np.zeros((size, size)), np.zeros(size)
        add_model_rows(
            JtJ, Jtr, J, rows[corners], matches.weights, matches.directions, -matches.offsets, MM * MM * here.weights
        )
        if len(here.back_weights):
            ids = np.repeat(rows[self.inner[: len(here.back_weights), None]], 3, axis=1)
            shares = np.zeros((len(ids), 3))
            shares[:, 0] = 1.0
            add_model_rows(JtJ, Jtr, J, ids, shares, here.back_normals, here.back_offsets, MM * MM * here.back_weights)
        JtJ = np.tril(JtJ) + np.tril(JtJ, -1).T
        prior_JtJ, prior_Jtr = self.prior_equations(here.state, settings.pose_weight, settings.shape_weight)
        JtJ += prior_JtJ
        Jtr += prior_Jtr
        JtJ[np.arange(6), np.arange(6)] += 1e-6 * max(float(JtJ.diagonal()[:6].max()), 1e-9)
        return JtJ, Jtr

    # What is fitted: a model with few parameters of its own says these in another way.

    def pose(self, state: HandState) -> Posed:
        """The surface at a state."""
        return state.posed(self.model)

    def jacobian(self, posed: Posed, vertex_ids: npt.NDArray[np.int64] | None = None) -> Array:
        """(N, 3, P) derivative of vertices (N,), of all when left out, by the parameters, m."""
        return posed.vertex_jacobian(vertex_ids)

    def move(self, state: HandState, step: Array) -> HandState:
        """The state after a step (P,)."""
        return state.retract(self.model, step)

    def prior_cost(self, state: HandState, pose_weight: float, shape_weight: float) -> float:
        """λ_θ E_θ + λ_β E_β of [R17] Eq. 5."""
        return pose_weight * self.prior.cost(state.pose[1:]) + shape_weight * float(state.shape @ state.shape)

    def prior_equations(self, state: HandState, pose_weight: float, shape_weight: float) -> tuple[Array, Array]:
        """JtJ (P, P) and Jtr (P,) of the same."""
        size, first, last = self.model.num_parameters, 6, 3 + 3 * len(self.model.parents)
        JtJ, Jtr = np.zeros((size, size)), np.zeros(size)
        _, prior_JtJ, prior_Jtr = self.prior.linearize(state.pose[1:])
        JtJ[first:last, first:last] = pose_weight * prior_JtJ
        Jtr[first:last] = pose_weight * prior_Jtr
        JtJ[np.arange(last, size), np.arange(last, size)] = shape_weight
        Jtr[last:] = shape_weight * state.shape
        return JtJ, Jtr


def weigh_matches(matches: Matches, reach: float, sigma: float) -> tuple[Array, float]:
    """Weights (N,) of matched points, 0 on the rim and where nothing lies within `reach`, m, and the sum of ρ, m²."""
    weights, is_found = np.empty(len(matches.faces)), matches.faces >= 0
    missing = float(np.count_nonzero(~is_found)) * saturated(reach, sigma)
    total = weigh_robustly(weights, matches.offsets, sigma) + missing
    return weights * (is_found & ~matches.on_rim), total


def saturated(reach: float, sigma: float) -> float:
    """Cost of a point that nothing lies within `reach` of."""
    return reach * reach * sigma * sigma / (reach * reach + sigma * sigma)


def spread(vertices: Array, wanted: npt.NDArray[np.bool_], most: int = 2000) -> npt.NDArray[np.int64]:
    """Ids of the wanted vertices, each next one the farthest from all before it; of no more than `most` of them."""
    ids = np.flatnonzero(wanted)
    points = vertices[ids]
    order = [0]
    distances = np.linalg.norm(points - points[0], axis=1)
    for _ in range(min(len(ids), most) - 1):
        order.append(int(np.argmax(distances)))
        distances = np.minimum(distances, np.linalg.norm(points - points[order[-1]], axis=1))
    return ids[order].astype(np.int64)

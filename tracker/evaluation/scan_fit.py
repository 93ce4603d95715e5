"""How near a hand model comes to a scan: pose, and shape if asked for, fitted from a known start.

What is judged is the model and not the search for a pose, so a fit begins at the model's best fit to the true vertices.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve

from tracker.model.blend_model import BlendModel, PosedBlend
from tracker.model.skinning import keep_heaviest
from tracker.registration.equations import add_model_rows, weigh_robustly
from tracker.registration.surface_search import SurfaceSearch
from tracker.solver.minimize import minimize_damped
from tracker.training.pose_fit import Hands, fit_poses, start_poses
from tracker.training.rig import Rig
from tracker.training.spaces import compute_rotation_vectors

Array = npt.NDArray[np.float64]

SIGMA = 0.005
"""Scale of the Geman-McClure function, m."""

REACH = 0.02
"""Points farther from the surface than this are not fitted, m."""

SHAPE_WEIGHT = 0.1
"""Of (shape)² against mm² per vertex."""


@dataclass(frozen=True)
class HandFit:
    """pose (B, 3) rad, shape (S,), translation (3,) m, and the hand so posed."""

    pose: Array
    shape: Array
    translation: Array
    posed: PosedBlend


def without_pose_shapes(model: BlendModel) -> BlendModel:
    """The model with its pose blend shapes switched off, [R17] section 5.1."""
    return replace(model, pose_directions=np.zeros_like(model.pose_directions))


def with_template(model: BlendModel, template: Array) -> BlendModel:
    """The model of one person, whose rest shape (V, 3), m, is known."""
    return replace(model, template=template, shape_directions=np.zeros((*template.shape, 0)))


def fit_pose_to_vertices(model: BlendModel, vertices: Array, iterations: int = 20) -> HandFit:
    """The pose, mean shape, that lies nearest to vertices (V, 3), m."""
    rig = Rig(np.ascontiguousarray(model.parents), keep_heaviest(model.skinning_weights), model.pose_directions)
    templates, targets, owners = model.template[None], vertices[None], np.zeros(1, dtype=np.int64)
    joints = model.joints_of(model.template)[None]
    hands = Hands(targets, owners, templates, joints, rig)
    found = fit_poses(start_poses(hands), hands, iterations)
    return _at(model, compute_rotation_vectors(found.rotations[0]), np.zeros(model.num_shape), found.translations[0])


def fit_to_vertices(model: BlendModel, vertices: Array, iterations: int = 15) -> HandFit:
    """The pose and shape that lie nearest to vertices (V, 3), m, with the usual small weight on the shape."""

    def price(fit: HandFit) -> _Priced:
        return _Priced(fit, _cost_to_vertices(fit, vertices))

    def linearize(here: _Priced) -> tuple[Array, Array]:
        J = here.fit.posed.vertex_jacobian().reshape(-1, model.num_parameters) * 1e3
        r = (here.fit.posed.vertices - vertices).ravel() * 1e3
        return J.T @ J, J.T @ r

    def step(here: _Priced, equations: tuple[Array, Array], damping: float) -> _Priced:
        return price(_step(here.fit, *equations, damping))

    return minimize_damped(price(fit_pose_to_vertices(model, vertices)), linearize, step, iterations, 1e-5).fit


def fit_to_scan(
    start: HandFit,
    search: SurfaceSearch,
    points: Array,
    normals: Array,
    iterations: int = 12,
    num_components: int | None = None,
) -> HandFit:
    """Pose, and shape where the model has one, by point-to-surface distances.

    Args:
        start: Where to begin.
        search: Of the model's faces.
        points: (N, 3) of a hand, m; normals (N, 3).
        iterations: Gauss-Newton steps tried.
        num_components: Poses are confined to so many components of the model's pose space; None: they are free.
    """
    model = start.posed.model

    def price(fit: HandFit) -> _Priced:
        matched = _match(fit, search, points, normals)
        return _Priced(fit, matched.cost, matched)

    def linearize(here: _Priced) -> tuple[Array, Array]:
        matched = here.matched
        assert matched is not None
        H, g = np.zeros((model.num_parameters,) * 2), np.zeros(model.num_parameters)
        add_model_rows(
            H,
            g,
            here.fit.posed.vertex_jacobian(),
            search.faces[matched.faces],
            matched.shares,
            matched.directions,
            -matched.offsets,
            1e6 * matched.weights,
        )
        return H + np.tril(H, -1).T, g

    def step(here: _Priced, equations: tuple[Array, Array], damping: float) -> _Priced:
        return price(_step(here.fit, *equations, damping, num_components))

    begin = start if num_components is None else _confine(start, num_components)
    return minimize_damped(price(begin), linearize, step, iterations, 1e-4).fit


def measure_scan(fit: HandFit, search: SurfaceSearch, points: Array) -> Array:
    """(N,) distance from each point (N, 3) to the model's surface, m; NaN behind the open rim of the wrist."""
    found = search.match(fit.posed.vertices, points, np.zeros_like(points), 10.0)
    return np.where(found.on_rim, np.nan, np.abs(found.offsets))


@dataclass(frozen=True)
class _Matched:
    faces: npt.NDArray[np.int32]
    shares: Array
    directions: Array
    offsets: Array
    weights: Array
    cost: float


def _match(fit: HandFit, search: SurfaceSearch, points: Array, normals: Array) -> _Matched:
    found = search.match(fit.posed.vertices, points, normals, REACH)
    weights = np.empty(len(points))
    is_used = (found.faces >= 0) & ~found.on_rim
    scale = len(fit.posed.vertices) / len(points)
    offsets = np.where(is_used, found.offsets, REACH)
    cost = 1e6 * scale * weigh_robustly(weights, offsets, SIGMA) + SHAPE_WEIGHT * float(fit.shape @ fit.shape)
    return _Matched(found.faces, found.weights, found.directions, found.offsets, scale * weights * is_used, float(cost))


@dataclass(frozen=True)
class _Priced:
    """A fit, what it costs, and where the points lie on it."""

    fit: HandFit
    cost: float
    matched: _Matched | None = None


def _cost_to_vertices(fit: HandFit, vertices: Array) -> float:
    return 1e6 * float(np.sum((fit.posed.vertices - vertices) ** 2)) + SHAPE_WEIGHT * float(fit.shape @ fit.shape)


def _step(here: HandFit, H: Array, g: Array, damping: float, num_components: int | None = None) -> HandFit:
    """Where a damped step leads; with `num_components`, within that many components of the pose space."""
    model = here.posed.model
    first = 3 + 3 * model.num_bones
    H, g = H.copy(), g.copy()
    H[np.arange(first, len(g)), np.arange(first, len(g))] += SHAPE_WEIGHT
    g[first:] += SHAPE_WEIGHT * here.shape
    basis = _basis(here, num_components)
    reduced = basis.T @ H @ basis
    reduced[np.diag_indices_from(reduced)] *= 1.0 + damping
    reduced[np.diag_indices_from(reduced)] += 1e-9 * np.trace(reduced)
    inner = -cho_solve(cho_factor(reduced, lower=True), basis.T @ g)
    if num_components is None:
        return _at(model, *model.retract(here.pose, here.shape, here.translation, basis @ inner))
    step = np.zeros(model.num_parameters)
    step[:6], step[first:] = inner[:6], inner[6 + num_components :]
    pose, shape, translation = model.retract(here.pose, here.shape, here.translation, step)
    pose[1:] = here.pose[1:] + (inner[6 : 6 + num_components] @ model.pose_components[:num_components]).reshape(-1, 3)
    return _at(model, pose, shape, translation)


def _basis(here: HandFit, num_components: int | None) -> Array:
    """(P, D) what the steps of the parameters may be made of."""
    model = here.posed.model
    size, K = model.num_parameters, model.num_bones - 1
    if num_components is None:
        return np.eye(size)
    turns = np.zeros((3 * K, 3 * K))
    for k in range(K):
        turns[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = find_left_jacobian(here.pose[1 + k])
    basis = np.zeros((size, 6 + num_components + model.num_shape))
    basis[:6, :6] = np.eye(6)
    basis[6 : 6 + 3 * K, 6 : 6 + num_components] = turns @ model.pose_components[:num_components].T
    basis[6 + 3 * K :, 6 + num_components :] = np.eye(model.num_shape)
    return basis


def find_left_jacobian(vector: Array) -> Array:
    """(3, 3) L with exp(v + dv) = exp(L dv) exp(v) to first order, v a rotation vector."""
    angle = float(np.linalg.norm(vector))
    x, y, z = vector
    W = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    if angle < 1e-6:
        return np.eye(3) + 0.5 * W
    return np.eye(3) + (1.0 - np.cos(angle)) / angle**2 * W + (angle - np.sin(angle)) / angle**3 * (W @ W)


def _confine(fit: HandFit, num_components: int) -> HandFit:
    """The nearest pose of the model's pose space."""
    model = fit.posed.model
    components = model.pose_components[:num_components]
    pose = fit.pose.copy()
    pose[1:] = (model.pose_mean + components.T @ (components @ (pose[1:].ravel() - model.pose_mean))).reshape(-1, 3)
    return _at(model, pose, fit.shape, fit.translation)


def _at(model: BlendModel, pose: Array, shape: Array, translation: Array) -> HandFit:
    return HandFit(pose, shape, translation, model.pose_at(pose, shape, translation))

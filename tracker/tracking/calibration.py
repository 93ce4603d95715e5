"""Fit the shape of a hand to a few frames of depth, together with its poses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import PosedScene, Scene
from tracker.model.shape import with_shape
from tracker.observation import Observation
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import MILLIMETRES
from tracker.tracking.frame_fit import FitOptions, find_residuals, fit_frame
from tracker.tracking.objective import Objective

Array = npt.NDArray[np.float64]


FEW = 4
"""With fewer frames than this the prior grows: pose and shape of one frame explain each other away."""


@dataclass(frozen=True)
class CalibrationOptions:
    """How a shape is fitted.

    Attributes:
        rounds: Shape steps, each after refitting every pose.
        iterations: Iterations of each refit.
        prior: Weight of β² against the squared mm of one frame's correspondences, each; more frames outweigh it.
        modes: Leading coefficients that are fitted; the rest say too little in depth and keep their start.
        step: Finite difference of a shape parameter.
    """

    rounds: int = 8
    iterations: int = 4
    prior: float = 0.15
    modes: int = 6
    step: float = 1e-3


@dataclass(frozen=True)
class Calibrated:
    """A fitted shape.

    Attributes:
        model: The hand with the shape baked in.
        shape: (S,) its coefficients.
        poses: (D,) of each frame, of that model.
    """

    model: ArticulatedModel
    shape: Array
    poses: list[Array]


def calibrate_shape(
    base: ArticulatedModel,
    start: Array,
    observations: list[Observation],
    poses: list[Array],
    options: CalibrationOptions | None = None,
    progress: Callable[[float], None] | None = None,
) -> Calibrated:
    """Alternate between poses and shape; each shape step eliminates the poses by their Schur complement.

    Args:
        base: The hand with a shape basis.
        start: (S,) coefficients to start at.
        observations: One a frame.
        poses: (D,) one a frame, near the truth.
        options: How.
        progress: Told the share done.
    """
    options = options or CalibrationOptions()
    assert base.shape is not None, "a model without a shape basis has nothing to calibrate"
    objective, shape, poses = Objective(), start.copy(), list(poses)
    for turn in range(options.rounds):
        scene = Scene((with_shape(base, shape),))
        poses = [
            fit_frame(scene, seen, pose, pose, objective, FitOptions(iterations=options.iterations)).pose
            for seen, pose in zip(observations, poses, strict=True)
        ]
        A = np.zeros((len(shape), len(shape)))
        b = np.zeros(len(shape))
        count = 0
        for seen, pose in zip(observations, poses, strict=True):
            A_frame, b_frame, count_frame = _reduced_equations(base, shape, scene, seen, pose, objective, options.step)
            A += A_frame
            b += b_frame
            count += count_frame
        weight = options.prior * count / len(observations) * max(1.0, FEW / len(observations)) ** 2
        A[np.diag_indices_from(A)] += weight
        free = slice(0, options.modes)
        change = np.zeros_like(shape)
        change[free] = np.clip(np.linalg.solve(A[free, free], -(b + weight * shape)[free]), -0.7, 0.7)
        shape = np.clip(shape + change, base.shape.lower, base.shape.upper)
        if progress:
            progress((turn + 1) / options.rounds)
    scene = Scene((with_shape(base, shape),))
    final = FitOptions(iterations=2 * options.iterations)
    poses = [
        fit_frame(scene, seen, pose, pose, objective, final).pose
        for seen, pose in zip(observations, poses, strict=True)
    ]
    return Calibrated(scene.models[0], shape, poses)


def _reduced_equations(
    base: ArticulatedModel,
    shape: Array,
    scene: Scene,
    observation: Observation,
    pose: Array,
    objective: Objective,
    step: float,
) -> tuple[Array, Array, int]:
    """Normal equations (S, S) and (S,) of the shape with this frame's pose eliminated, and its correspondences."""
    posed = scene.pose_at(pose)
    residuals = find_residuals(posed, observation, objective)
    moves = _shape_derivative(base, shape, posed, pose, step)
    A_pp, _, _ = objective.linearize(posed, residuals, pose)
    A_pp[np.diag_indices_from(A_pp)] *= 1.0 + 1e-3
    A_ps = np.zeros((scene.num_dofs, len(shape)))
    A_ss, b_s, b_p = np.zeros((len(shape), len(shape))), np.zeros(len(shape)), np.zeros(scene.num_dofs)
    count = 0
    for residual in residuals.values():
        if not isinstance(residual, PointToPlane) or residual.count == 0:
            continue
        block = residual.linearize(posed)
        along = np.einsum("ni,snci,nc->ns", residual.normals, moves[:, residual.ids], residual.barycentric)
        J_s = MILLIMETRES * along
        weighted = block.weights[:, None] * J_s
        A_ss += weighted.T @ J_s
        A_ps += block.jacobian.T @ weighted
        b_s += weighted.T @ block.residual
        b_p += block.jacobian.T @ (block.weights * block.residual)
        count += residual.count
    eliminated = np.linalg.solve(A_pp, np.column_stack([A_ps, b_p]))
    return A_ss - A_ps.T @ eliminated[:, :-1], b_s - A_ps.T @ eliminated[:, -1], count


def _shape_derivative(base: ArticulatedModel, shape: Array, posed: PosedScene, pose: Array, step: float) -> Array:
    """(S, V, 3) derivative of the posed vertices by each shape coefficient, m."""
    moves = np.zeros((len(shape), *posed.vertices.shape))
    for index in range(len(shape)):
        ahead = shape.copy()
        ahead[index] += step
        moves[index] = (Scene((with_shape(base, ahead),)).pose_at(pose).vertices - posed.vertices) / step
    return moves


def propose_shapes(base: ArticulatedModel) -> list[Array]:
    """Shape coefficients (S,) to try beside the mean hand: smaller and larger ones."""
    assert base.shape is not None
    place = base.shape.names.index("size")
    shapes = []
    for size in (-1.0, 1.0):
        shape = np.zeros(len(base.shape.names))
        shape[place] = np.clip(size, base.shape.lower[place], base.shape.upper[place])
        shapes.append(shape)
    return shapes

"""Normal equations of hand shapes, with the pose of each frame eliminated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from tracker.fitting.frame_fit import find_residuals
from tracker.fitting.objective import Objective
from tracker.model.hand_directions import HandDirections
from tracker.model.scene import PosedScene, Scene
from tracker.model.skinning import shift_bones
from tracker.observation import Observation
from tracker.solver.elimination import add_shared_rows, solve_definite, subtract_product
from tracker.terms.normal_equations import MILLIMETRES
from tracker.terms.point_line import PointToLine
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import Residual

Array = npt.NDArray[np.float64]

FLOOR = 1e-8
"""Share of the largest diagonal entry that is added to all."""


@dataclass(frozen=True)
class ShapeEquations:
    """One frame's normal equations: the shapes' with the pose eliminated, and how the pose follows the shapes.

    Attributes:
        A: (S, S) mm² per square unit.
        b: (S,) gradient, mm² per unit.
        follow: (D, S) and `settle` (D,): the pose's step is settle − follow · (the shapes' step).
        settle: (D,).
        count: Correspondences.
        cost: Sum of their weighted squares, mm².
    """

    A: Array
    b: Array
    follow: Array
    settle: Array
    count: int
    cost: float


@dataclass(frozen=True)
class SceneDirections:
    """Shape directions of the models of a scene, stacked, in the frames of the models, m.

    Attributes:
        slices: For each model its place among the S values; empty for one whose shape is fixed.
        vertices: (V, 3, S) landmarks included.
        joints: (B, 3, S).
    """

    slices: tuple[slice, ...]
    vertices: Array
    joints: Array

    @classmethod
    def stack(cls, scene: Scene, directions: tuple[HandDirections | None, ...]) -> SceneDirections:
        counts = [0 if own is None else len(own.names) for own in directions]
        ends = np.cumsum(counts)
        slices = tuple(slice(int(end - count), int(end)) for end, count in zip(ends, counts, strict=True))
        vertices = np.zeros((len(scene.vertex_models), 3, int(ends[-1])))
        joints = np.zeros((len(scene.arrays.parents), 3, int(ends[-1])))
        for index, (own, where) in enumerate(zip(directions, slices, strict=True)):
            if own is not None:
                landmarks = own.of_landmarks(scene.models[index])
                vertices[scene.vertex_slices[index], :, where] = own.vertices.transpose(1, 2, 0)
                vertices[scene.landmark_slices[index], :, where] = landmarks.transpose(1, 2, 0)
                joints[scene.bone_slices[index], :, where] = own.joints.transpose(1, 2, 0)
        return cls(slices, vertices, joints)


def shape_derivative(posed: PosedScene, directions: SceneDirections) -> Array:
    """(V, 3, S) derivative of the posed vertices, landmarks included, by each value, world, m.

    Bones shift with their joints at rest (`shift_bones`); a vertex of the bones j moves by its own Σ κ_j R_j δ besides.
    """
    arrays = posed.scene.arrays
    R = posed.Ms[:, :, :3]
    shifts = shift_bones(
        posed.Ms, arrays.parents, np.where((arrays.parents < 0)[:, None, None], 0.0, directions.joints)
    )
    rows = np.repeat(np.arange(len(arrays.weights)), arrays.weights.shape[1])
    weights = csr_matrix((arrays.weights.ravel(), (rows, arrays.weight_bones.ravel())), (len(posed.vertices), len(R)))
    turns = (weights @ R.reshape(-1, 9)).reshape(-1, 3, 3)
    return turns @ directions.vertices + (weights @ shifts.reshape(len(R), -1)).reshape(len(turns), 3, -1)


def reduce_equations(
    scene: Scene,
    directions: SceneDirections,
    observation: Observation | None,
    pose: Array,
    objective: Objective,
    damping: float = 1e-3,
) -> ShapeEquations:
    """The equations of one frame at its pose (D,), from every correspondence that its terms find."""
    posed = scene.pose_at(pose)
    residuals = find_residuals(posed, observation, objective)
    moves = shape_derivative(posed, directions)
    size = directions.joints.shape[2]
    A_pp, b_p, _ = objective.linearize(posed, residuals, pose)
    diagonal = np.diagonal(A_pp).copy()
    # What nothing observes, the turn of a pipe about its axis, stays where it is.
    A_pp[np.diag_indices_from(A_pp)] += damping * diagonal + FLOOR * max(float(diagonal.max()), 1e-12)
    A_ss, b_s, A_ps = np.zeros((size, size)), np.zeros(size), np.zeros((scene.num_dofs, size))
    count, cost = 0, 0.0
    for residual in residuals.values():
        if residual.count:
            block = residual.linearize(posed)
            J_s = MILLIMETRES * _by_shape(residual, moves)
            add_shared_rows(A_ss, A_ps, b_s, J_s, block.jacobian, block.residual, block.weights)
            count += residual.count
            cost += float(block.weights @ block.residual**2)
    A_ss += np.tril(A_ss, -1).T
    eliminated = solve_definite(A_pp, np.column_stack([A_ps, -b_p]))
    follow, settle = np.ascontiguousarray(eliminated[:, :-1]), eliminated[:, -1].copy()
    subtract_product(A_ss, A_ps, follow)
    return ShapeEquations(A_ss, b_s + settle @ A_ps, follow, settle, count, cost)


def _by_shape(residual: Residual, moves: Array) -> Array:
    """(M, S) derivative of each row of a residual, per m."""
    assert isinstance(residual, PointToPlane | PointToLine), type(residual)
    rows = np.repeat(np.arange(residual.count), 9)
    columns = (3 * residual.ids[:, :, None] + np.arange(3)).reshape(-1)
    flat = moves.reshape(3 * len(moves), -1)
    shape = (residual.count, len(flat))
    if isinstance(residual, PointToPlane):
        shares = residual.barycentric[:, :, None] * residual.normals[:, None]
        return np.asarray(csr_matrix((shares.reshape(-1), (rows, columns)), shape) @ flat)
    d = residual.directions
    none = np.zeros(len(d))
    across = np.stack([[none, d[:, 2], -d[:, 1]], [-d[:, 2], none, d[:, 0]], [d[:, 1], -d[:, 0], none]])  # v × d
    out = np.zeros((residual.count, 3, flat.shape[1]))
    for row in range(3):
        shares = residual.barycentric[:, :, None] * across[row].T[:, None]
        out[:, row] = csr_matrix((shares.reshape(-1), (rows, columns)), shape) @ flat
    return out.reshape(3 * residual.count, -1)

"""Residual kind: distance of a surface point from a plane, r = nᵀ(v − X), [T16] Eq. 7."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.scene import PosedScene
from tracker.terms.normal_equations import MAX_BONES, MILLIMETRES, NormalEquations, add_row, gather_bones
from tracker.terms.residual import ResidualBlock
from tracker.terms.surface_rows import SurfaceRows

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PointToPlane(SurfaceRows):
    """Surface points and the planes they should lie in; the normals are held fixed.

    Attributes:
        targets: (N, 3) a point of each plane, world, m.
        normals: (N, 3) unit, world.
        weights: (N,).
    """

    targets: Array
    normals: Array
    weights: Array

    def linearize(self, posed: PosedScene) -> ResidualBlock:
        residual = np.einsum("ni,ni->n", self.normals, self.points(posed) - self.targets)
        jacobian = np.zeros((self.count, posed.scene.num_dofs))
        for corner in range(3):
            moves = posed.vertex_jacobian(self.ids[:, corner])
            jacobian += self.barycentric[:, corner, None] * np.einsum("ni,nid->nd", self.normals, moves)
        return ResidualBlock(MILLIMETRES * residual, MILLIMETRES * jacobian, self.weights)

    def add_to(self, equations: NormalEquations) -> None:
        posed, arrays = equations.posed, equations.posed.scene.arrays
        equations.cost += _add_rows(
            equations.blocks,
            equations.gradients,
            equations.pair_index,
            self.ids,
            self.barycentric,
            self.targets,
            self.normals,
            self.weights,
            (posed.vertices, arrays.weight_bones, arrays.weights, posed.bone_vertices),
        )
        equations.count += self.count

    def segments(self, posed: PosedScene) -> Array:
        return np.stack([self.points(posed), self.targets], axis=1)


@njit(cache=True, nogil=True)
def _add_rows(blocks, gradients, pair_index, ids, barycentric, targets, normals, weights, skinned):
    vertices, weight_bones, skinning, bone_vertices = skinned
    bones = np.zeros(MAX_BONES, dtype=np.int32)
    sums = np.zeros((MAX_BONES, 4))
    wrenches = np.zeros((MAX_BONES, 6))
    cost = 0.0
    for row in range(len(ids)):
        nx, ny, nz = normals[row, 0], normals[row, 1], normals[row, 2]
        residual = 0.0
        for corner in range(3):
            share = barycentric[row, corner]
            if share != 0.0:
                v = ids[row, corner]
                residual += share * (nx * vertices[v, 0] + ny * vertices[v, 1] + nz * vertices[v, 2])
        residual -= nx * targets[row, 0] + ny * targets[row, 1] + nz * targets[row, 2]
        weight = weights[row] * MILLIMETRES * MILLIMETRES
        cost += weight * residual * residual
        count = gather_bones(bones, sums, ids[row], barycentric[row], weight_bones, skinning, bone_vertices)
        add_row(blocks, gradients, pair_index, bones, sums, count, wrenches, (nx, ny, nz), residual, weight)
    return cost

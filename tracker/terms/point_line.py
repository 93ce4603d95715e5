"""Residual kind: distance of a surface point from a line in Plücker coordinates, r = v × d − m, [T16] Eq. 8."""

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
class PointToLine(SurfaceRows):
    """Surface points and the viewing rays they should lie on.

    Attributes:
        directions: (N, 3) unit direction d of each line, world.
        moments: (N, 3) moment m = x × d of each line, world, m.
        weights: (N,).
    """

    directions: Array
    moments: Array
    weights: Array

    def linearize(self, posed: PosedScene) -> ResidualBlock:
        residual = np.cross(self.points(posed), self.directions) - self.moments  # (N, 3)
        jacobian = np.zeros((self.count, 3, posed.scene.num_dofs))
        for corner in range(3):
            moves = posed.vertex_jacobian(self.ids[:, corner])
            turned = np.cross(moves, self.directions[:, :, None], axis=1)
            jacobian += self.barycentric[:, corner, None, None] * turned
        return ResidualBlock(
            MILLIMETRES * residual.reshape(-1),
            MILLIMETRES * jacobian.reshape(3 * self.count, posed.scene.num_dofs),
            np.repeat(self.weights, 3),
        )

    def add_to(self, equations: NormalEquations) -> None:
        posed, arrays = equations.posed, equations.posed.scene.arrays
        equations.cost += _add_rows(
            equations.blocks,
            equations.gradients,
            equations.pair_index,
            self.ids,
            self.barycentric,
            self.directions,
            self.moments,
            self.weights,
            (posed.vertices, arrays.weight_bones, arrays.weights, posed.bone_vertices),
        )
        equations.count += self.count

    def segments(self, posed: PosedScene) -> Array:
        points = self.points(posed)
        feet = np.cross(self.directions, self.moments)  # nearest point of each line to the origin
        along = np.einsum("ni,ni->n", points - feet, self.directions)
        return np.stack([points, feet + along[:, None] * self.directions], axis=1)


def find_slack(points: Array, directions: Array, moments: Array, reach: float) -> Array:
    """(N,) what the weights of points (N, 3), world, m, are divided by, so that one that is told wrongly lets go.

    With the distance r of a point from its line this is (1 + (r / reach)²)², which makes the sum Geman's and McClure's.

    Args:
        points: (N, 3) world, m.
        directions: (N, 3) of the lines; moments (N, 3).
        reach: mm.
    """
    (x, y, z), (u, v, w) = points.T, directions.T
    away = np.linalg.norm(np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1) - moments, axis=1)
    return (1.0 + (MILLIMETRES * away / reach) ** 2) ** 2


@njit(cache=True, nogil=True)
def _add_rows(blocks, gradients, pair_index, ids, barycentric, directions, moments, weights, skinned):
    vertices, weight_bones, skinning, bone_vertices = skinned
    bones = np.zeros(MAX_BONES, dtype=np.int32)
    sums = np.zeros((MAX_BONES, 4))
    wrenches = np.zeros((MAX_BONES, 6))
    cost = 0.0
    for row in range(len(ids)):
        x = y = z = 0.0
        for corner in range(3):
            share = barycentric[row, corner]
            if share != 0.0:
                v = ids[row, corner]
                x += share * vertices[v, 0]
                y += share * vertices[v, 1]
                z += share * vertices[v, 2]
        dx, dy, dz = directions[row, 0], directions[row, 1], directions[row, 2]
        # |v × d − m| is the distance across d: two rows along n and d × n measure the same as the three of Eq. 8.
        fx, fy, fz = (
            dy * moments[row, 2] - dz * moments[row, 1],
            dz * moments[row, 0] - dx * moments[row, 2],
            dx * moments[row, 1] - dy * moments[row, 0],
        )
        if abs(dx) < 0.7:
            nx, ny, nz = 0.0, dz, -dy
        else:
            nx, ny, nz = -dz, 0.0, dx
        scale = 1.0 / np.sqrt(nx * nx + ny * ny + nz * nz)
        nx, ny, nz = nx * scale, ny * scale, nz * scale
        ox, oy, oz = dy * nz - dz * ny, dz * nx - dx * nz, dx * ny - dy * nx
        first = nx * (x - fx) + ny * (y - fy) + nz * (z - fz)
        second = ox * (x - fx) + oy * (y - fy) + oz * (z - fz)
        weight = weights[row] * MILLIMETRES * MILLIMETRES
        cost += weight * (first * first + second * second)
        count = gather_bones(bones, sums, ids[row], barycentric[row], weight_bones, skinning, bone_vertices)
        add_row(blocks, gradients, pair_index, bones, sums, count, wrenches, (nx, ny, nz), first, weight)
        add_row(blocks, gradients, pair_index, bones, sums, count, wrenches, (ox, oy, oz), second, weight)
    return cost

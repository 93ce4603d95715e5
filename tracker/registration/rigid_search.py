"""Thousands of rough rigid placements of hands on a scan, each refined."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.registration.nearest_grid import NearestGrid, look_up

Array = npt.NDArray[np.float64]

SIGMAS = (0.03, 0.03, 0.025, 0.02, 0.018, 0.015, 0.012, 0.010)
"""Scale of the Geman-McClure function in each iteration, m."""

JUDGED = 0.006
"""That of the last look, m."""

MIN_COSINE = 0.3
"""A point whose normal is turned farther than this from a vertex's is not its match."""
SIZE_DEVIATION = 0.08
"""Of the size of hands."""


@dataclass(frozen=True)
class StiffHand:
    """A hand that keeps its pose.

    Attributes:
        grid: Its vertices (V, 3), m, their normals, and where they are.
        is_rim: (V,) vertices that attract nothing.
        chosen: (C,) vertices that look for the scan.
    """

    grid: NearestGrid
    is_rim: npt.NDArray[np.bool_]
    chosen: npt.NDArray[np.int64]


@dataclass(frozen=True)
class Placing:
    """p = size R v + t for a vertex v, and the cost a point, m², of which low is good."""

    R: Array
    t: Array
    size: float
    cost: float


def place_stiffly(
    hand: StiffHand, scan: NearestGrid, few: Array, few_normals: Array, Rs: Array, ts: Array
) -> list[Placing]:
    """Every given placing after some steps of Gauss-Newton on distances both ways.

    Args:
        hand: The hand.
        scan: Points of the scan to be looked for.
        few: (N, 3) points of the scan that look for the hand, m.
        few_normals: (N, 3).
        Rs: (C, 3, 3) rotations to begin with.
        ts: (C, 3) m.
    """
    Rs, ts = np.ascontiguousarray(Rs), np.ascontiguousarray(ts)
    sizes, costs = np.ones(len(Rs)), np.zeros(len(Rs))
    Rs, ts = Rs.copy(), ts.copy()
    grid = hand.grid
    _place_into(
        (Rs, ts, sizes, costs),
        (grid.points, grid.normals, grid.nearest, grid.origin, hand.is_rim, hand.chosen),
        (scan.points, scan.normals, scan.nearest, scan.origin),
        (few, few_normals),
        np.array(SIGMAS),
    )
    return [Placing(R, t, float(size), float(cost)) for R, t, size, cost in zip(Rs, ts, sizes, costs, strict=True)]


@njit(cache=True, nogil=True)
def _place_into(placings, hand, scan, asking, sigmas):
    """Improve placings in place.

    Args:
        placings: Rs (C, 3, 3), ts (C, 3) and sizes (C,) in and out, costs (C,) out.
        hand: points, normals, nearest and origin of its grid, which vertices are on the rim, those that ask.
        scan: points, normals, nearest and origin of its grid.
        asking: points (N, 3) of the scan that look for the hand, and their normals.
        sigmas: Scales of the steps, m.
    """
    Rs, ts, sizes, costs = placings
    vertices, normals, nearest, origin, is_rim, chosen = hand
    points, point_normals, scan_nearest, scan_origin = scan
    few, few_normals = asking
    A, b, row = np.zeros((7, 7)), np.zeros(7), np.zeros(7)
    for c in range(len(Rs)):
        R, t, size = Rs[c], ts[c], sizes[c]
        for step in range(len(sigmas) + 1):
            is_last = step == len(sigmas)
            sigma = JUDGED if is_last else sigmas[step]
            square = sigma * sigma
            A[:] = 0.0
            b[:] = 0.0
            total = 0.0
            both = len(few) + len(chosen)
            for n in range(both):
                if n < len(few):  # from the scan to the hand
                    px, py, pz = few[n, 0], few[n, 1], few[n, 2]
                    ux, uy, uz = (px - t[0]) / size, (py - t[1]) / size, (pz - t[2]) / size
                    v = look_up(
                        nearest,
                        origin,
                        R[0, 0] * ux + R[1, 0] * uy + R[2, 0] * uz,
                        R[0, 1] * ux + R[1, 1] * uy + R[2, 1] * uz,
                        R[0, 2] * ux + R[1, 2] * uy + R[2, 2] * uz,
                    )
                    if is_rim[v]:
                        continue
                    mx, my, mz = few_normals[n, 0], few_normals[n, 1], few_normals[n, 2]
                    share = 1.0 / len(few)
                else:
                    v = chosen[n - len(few)]
                    share = 1.0 / len(chosen)
                a0, a1, a2 = vertices[v, 0], vertices[v, 1], vertices[v, 2]
                qx = size * (R[0, 0] * a0 + R[0, 1] * a1 + R[0, 2] * a2)
                qy = size * (R[1, 0] * a0 + R[1, 1] * a1 + R[1, 2] * a2)
                qz = size * (R[2, 0] * a0 + R[2, 1] * a1 + R[2, 2] * a2)
                a0, a1, a2 = normals[v, 0], normals[v, 1], normals[v, 2]
                nx = R[0, 0] * a0 + R[0, 1] * a1 + R[0, 2] * a2
                ny = R[1, 0] * a0 + R[1, 1] * a1 + R[1, 2] * a2
                nz = R[2, 0] * a0 + R[2, 1] * a1 + R[2, 2] * a2
                if n >= len(few):
                    p = look_up(scan_nearest, scan_origin, qx + t[0], qy + t[1], qz + t[2])
                    px, py, pz = points[p, 0], points[p, 1], points[p, 2]
                    mx, my, mz = point_normals[p, 0], point_normals[p, 1], point_normals[p, 2]
                has_normal = mx != 0.0 or my != 0.0 or mz != 0.0
                if has_normal and mx * nx + my * ny + mz * nz < MIN_COSINE:
                    total += share * square
                    continue
                if n >= len(few) and has_normal:
                    nx, ny, nz = mx, my, mz
                dx, dy, dz = qx + t[0] - px, qy + t[1] - py, qz + t[2] - pz
                along = dx * nx + dy * ny + dz * nz
                # grids are coarse: what lies off along the surface counts a quarter
                r2 = 0.75 * along * along + 0.25 * (dx * dx + dy * dy + dz * dz)
                robust = square / (square + r2)
                total += share * r2 * robust
                if is_last:
                    continue
                w = share * robust * robust
                row[0], row[1], row[2] = qy * nz - qz * ny, qz * nx - qx * nz, qx * ny - qy * nx
                row[3], row[4], row[5] = nx, ny, nz
                row[6] = (qx * nx + qy * ny + qz * nz) / size
                for i in range(7):
                    b[i] -= w * row[i] * along
                    for j in range(i + 1):
                        A[i, j] += w * row[i] * row[j]
            if is_last:
                costs[c] = total
                break
            stiff = 0.02 * square / (SIZE_DEVIATION * SIZE_DEVIATION)
            A[6, 6] += stiff
            b[6] -= stiff * (size - 1.0)
            for i in range(7):
                A[i, i] *= 1.001
                A[i, i] += 1e-9 if i < 3 else 1e-6
                for j in range(i):
                    A[j, i] = A[i, j]
            x = np.linalg.solve(A, b)
            angle = np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
            if angle > 0.4:
                x *= 0.4 / angle
                angle = 0.4
            s1 = np.sin(angle) / angle if angle > 1e-9 else 1.0
            s2 = (1.0 - np.cos(angle)) / (angle * angle) if angle > 1e-9 else 0.5
            for column in range(3):
                r0, r1, r2 = R[0, column], R[1, column], R[2, column]
                c0, c1, c2 = x[1] * r2 - x[2] * r1, x[2] * r0 - x[0] * r2, x[0] * r1 - x[1] * r0
                d0, d1, d2 = x[1] * c2 - x[2] * c1, x[2] * c0 - x[0] * c2, x[0] * c1 - x[1] * c0
                R[0, column] = r0 + s1 * c0 + s2 * d0
                R[1, column] = r1 + s1 * c1 + s2 * d1
                R[2, column] = r2 + s1 * c2 + s2 * d2
            t[0] += x[3]
            t[1] += x[4]
            t[2] += x[5]
            size = min(max(size + x[6], 0.8), 1.25)
        sizes[c] = size

"""Triangles against triangles, lines and points: kernels over vertex ids."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

EDGE = 1e-9
"""Share of a triangle by which a line may pass outside, so that none slips through between two neighbours."""


@njit(cache=True, nogil=True)
def do_triangles_cross(vertices, faces, f, g):
    """Whether triangles f and g have a point in common.

    By the intervals that each cuts from the line common to both planes. Triangles in one plane and triangles without
    area never cross: neither has a side to be on.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        f: One triangle.
        g: The other.
    """
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    p0x, p0y, p0z = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    p1x, p1y, p1z = vertices[b, 0], vertices[b, 1], vertices[b, 2]
    p2x, p2y, p2z = vertices[c, 0], vertices[c, 1], vertices[c, 2]
    a, b, c = faces[g, 0], faces[g, 1], faces[g, 2]
    q0x, q0y, q0z = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    q1x, q1y, q1z = vertices[b, 0], vertices[b, 1], vertices[b, 2]
    q2x, q2y, q2z = vertices[c, 0], vertices[c, 1], vertices[c, 2]
    ux, uy, uz = q1x - q0x, q1y - q0y, q1z - q0z
    wx, wy, wz = q2x - q0x, q2y - q0y, q2z - q0z
    mx, my, mz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx  # normal of g
    d0 = mx * (p0x - q0x) + my * (p0y - q0y) + mz * (p0z - q0z)
    d1 = mx * (p1x - q0x) + my * (p1y - q0y) + mz * (p1z - q0z)
    d2 = mx * (p2x - q0x) + my * (p2y - q0y) + mz * (p2z - q0z)
    if ((d0 > 0.0) & (d1 > 0.0) & (d2 > 0.0)) | ((d0 < 0.0) & (d1 < 0.0) & (d2 < 0.0)):
        return False
    ux, uy, uz = p1x - p0x, p1y - p0y, p1z - p0z
    wx, wy, wz = p2x - p0x, p2y - p0y, p2z - p0z
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx  # normal of f
    e0 = nx * (q0x - p0x) + ny * (q0y - p0y) + nz * (q0z - p0z)
    e1 = nx * (q1x - p0x) + ny * (q1y - p0y) + nz * (q1z - p0z)
    e2 = nx * (q2x - p0x) + ny * (q2y - p0y) + nz * (q2z - p0z)
    if ((e0 > 0.0) & (e1 > 0.0) & (e2 > 0.0)) | ((e0 < 0.0) & (e1 < 0.0) & (e2 < 0.0)):
        return False
    lx, ly, lz = abs(ny * mz - nz * my), abs(nz * mx - nx * mz), abs(nx * my - ny * mx)
    if lx + ly + lz == 0.0:
        return False
    if lx >= ly and lx >= lz:
        low_f, high_f, is_cut_f = _cut(p0x, p1x, p2x, d0, d1, d2)
        low_g, high_g, is_cut_g = _cut(q0x, q1x, q2x, e0, e1, e2)
    elif ly >= lz:
        low_f, high_f, is_cut_f = _cut(p0y, p1y, p2y, d0, d1, d2)
        low_g, high_g, is_cut_g = _cut(q0y, q1y, q2y, e0, e1, e2)
    else:
        low_f, high_f, is_cut_f = _cut(p0z, p1z, p2z, d0, d1, d2)
        low_g, high_g, is_cut_g = _cut(q0z, q1z, q2z, e0, e1, e2)
    return is_cut_f and is_cut_g and low_f <= high_g and low_g <= high_f


@njit(cache=True, nogil=True)
def _cut(x0, x1, x2, d0, d1, d2):
    """Interval along the line where the plane cuts a triangle, and whether it does."""
    if d0 * d1 > 0.0:
        x0, x2, d0, d2 = x2, x0, d2, d0
    elif d0 * d2 > 0.0:
        x0, x1, d0, d1 = x1, x0, d1, d0
    elif not (d1 * d2 > 0.0 or d0 != 0.0):
        if d1 != 0.0:
            x0, x1, d0, d1 = x1, x0, d1, d0
        elif d2 != 0.0:
            x0, x2, d0, d2 = x2, x0, d2, d0
        else:
            return 0.0, 0.0, False
    first = x0 + (x1 - x0) * d0 / (d0 - d1)  # corner 0 is alone on its side
    second = x0 + (x2 - x0) * d0 / (d0 - d2)
    return min(first, second), max(first, second), True


@njit(cache=True, nogil=True)
def meet_line(vertices, faces, f, x, y, z, dx, dy, dz):
    """Where the line through (x, y, z) along the unit (dx, dy, dz) meets triangle f.

    Returns:
        Signed distance along the line, m, and the cosine between line and triangle normal; the cosine is 0 where they
        do not meet.
    """
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    ux, uy, uz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
    wx, wy, wz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    slope = nx * dx + ny * dy + nz * dz
    if slope == 0.0:
        return 0.0, 0.0
    px, py, pz = ax - x, ay - y, az - z
    # barycentric coordinates from the volumes that the line spans with each side
    cx, cy, cz = py * dz - pz * dy, pz * dx - px * dz, px * dy - py * dx
    beta = (wx * cx + wy * cy + wz * cz) / slope
    gamma = -(ux * cx + uy * cy + uz * cz) / slope
    if (beta < -EDGE) | (gamma < -EDGE) | (beta + gamma > 1.0 + EDGE):
        return 0.0, 0.0
    return (nx * px + ny * py + nz * pz) / slope, slope / np.sqrt(nx * nx + ny * ny + nz * nz)


@njit(cache=True, nogil=True)
def find_closest(px, py, pz, vertices, a, b, c):
    """Squared distance from p to the triangle a, b, c, and weights of b and c at its closest point."""
    ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    ux, uy, uz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
    wx, wy, wz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
    qx, qy, qz = px - ax, py - ay, pz - az
    uu, uw, ww = ux * ux + uy * uy + uz * uz, ux * wx + uy * wy + uz * wz, wx * wx + wy * wy + wz * wz
    uq, wq = ux * qx + uy * qy + uz * qz, wx * qx + wy * qy + wz * qz
    area = uu * ww - uw * uw
    t = s = 0.0
    is_inside = False
    if area > 0.0:
        s, t = (ww * uq - uw * wq) / area, (uu * wq - uw * uq) / area
        is_inside = s >= 0.0 and t >= 0.0 and s + t <= 1.0
    if not is_inside:  # the nearest point of the three edges
        best = np.inf
        side = 0.0 if uu == 0.0 else min(max(uq / uu, 0.0), 1.0)
        dx, dy, dz = qx - side * ux, qy - side * uy, qz - side * uz
        best, s, t = dx * dx + dy * dy + dz * dz, side, 0.0
        side = 0.0 if ww == 0.0 else min(max(wq / ww, 0.0), 1.0)
        dx, dy, dz = qx - side * wx, qy - side * wy, qz - side * wz
        square = dx * dx + dy * dy + dz * dz
        if square < best:
            best, s, t = square, 0.0, side
        vx, vy, vz = wx - ux, wy - uy, wz - uz
        vv = vx * vx + vy * vy + vz * vz
        side = 0.0 if vv == 0.0 else ((qx - ux) * vx + (qy - uy) * vy + (qz - uz) * vz) / vv
        side = min(max(side, 0.0), 1.0)
        dx, dy, dz = qx - ux - side * vx, qy - uy - side * vy, qz - uz - side * vz
        square = dx * dx + dy * dy + dz * dz
        if square < best:
            best, s, t = square, 1.0 - side, side
    dx, dy, dz = qx - s * ux - t * wx, qy - s * uy - t * wy, qz - s * uz - t * wz
    return dx * dx + dy * dy + dz * dz, s, t


def is_watertight(faces: npt.NDArray[np.int64]) -> bool:
    """Whether every edge is run through once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)
    count = edges.max(initial=0) + 1
    forward = np.unique(edges[:, 0] * count + edges[:, 1])
    return len(forward) == len(edges) and np.array_equal(forward, np.unique(edges[:, 1] * count + edges[:, 0]))

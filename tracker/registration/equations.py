"""Normal equations of distances to a mesh, as kernels.

A row is the distance u · (p - Σ b v) of a point from the triangle that it was matched to, with u and b held: by the
envelope theorem the derivative of the true distance.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def weigh_robustly(weights, offsets, sigma):
    """Geman-McClure, [R17] Eq. 6: ρ(r) = r² σ² / (σ² + r²). Writes the weights (N,) of reweighted least squares.

    Returns:
        The sum of ρ.
    """
    total, square = 0.0, sigma * sigma
    for n in range(len(offsets)):
        r2 = offsets[n] * offsets[n]
        share = square / (square + r2)
        weights[n] = share * share
        total += r2 * share
    return total


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract"})
def add_model_rows(JtJ, Jtr, J, corners, shares, directions, residuals, weights):
    """Add w (u · Σ b J)' (u · Σ b J) and w (u · Σ b J)' r; only the lower triangle of JtJ is kept.

    Args:
        JtJ: (P, P).
        Jtr: (P,).
        J: (V, 3, P) derivative of the vertices.
        corners: (N, 3) vertices of a row.
        shares: (N, 3) their weights b.
        directions: (N, 3) u.
        residuals: (N,) u · (Σ b v - p).
        weights: (N,); rows of weight 0 are left out.
    """
    size = JtJ.shape[0]
    row = np.empty(size)
    used = np.empty(size, dtype=np.int64)
    for n in range(len(residuals)):
        w = weights[n]
        if w == 0.0:
            continue
        ux, uy, uz = directions[n, 0], directions[n, 1], directions[n, 2]
        for i in range(size):
            row[i] = 0.0
        for k in range(3):
            b = shares[n, k]
            if b != 0.0:
                v = corners[n, k]
                bx, by, bz = b * ux, b * uy, b * uz
                for i in range(size):
                    row[i] += bx * J[v, 0, i] + by * J[v, 1, i] + bz * J[v, 2, i]
        count = 0
        for i in range(size):
            if row[i] != 0.0:
                used[count] = i
                count += 1
        scaled = w * residuals[n]
        for a in range(count):
            i = used[a]
            value = w * row[i]
            Jtr[i] += scaled * row[i]
            for c in range(a + 1):
                j = used[c]
                JtJ[i, j] += value * row[j]


@njit(cache=True, nogil=True)
def add_surface_rows(blocks, right, places, faces, found, shares, directions, residuals, weights):
    """Add the same rows to the equations of free vertices.

    Args:
        blocks: (M, 3, 3) lower blocks of the matrix.
        right: (V, 3) sum of w J' r.
        places: (F, 6) where the blocks of a face lie: of its corners, then of 0-1, 1-2, 2-0.
        faces: (F, 3).
        found: (N,) face of a row, -1 leaves it out.
        shares: (N, 3).
        directions: (N, 3).
        residuals: (N,).
        weights: (N,).
    """
    for n in range(len(residuals)):
        w, f = weights[n], found[n]
        if w == 0.0 or f < 0:
            continue
        ux, uy, uz = directions[n, 0], directions[n, 1], directions[n, 2]
        for k in range(3):
            b = shares[n, k]
            value = w * b * residuals[n]
            v = faces[f, k]
            right[v, 0] += value * ux
            right[v, 1] += value * uy
            right[v, 2] += value * uz
        for k in range(6):
            if k < 3:
                value = w * shares[n, k] * shares[n, k]
            else:
                value = w * shares[n, k - 3] * shares[n, (k - 2) % 3]
            if value != 0.0:
                m = places[f, k]
                x, y, z = value * ux, value * uy, value * uz
                blocks[m, 0, 0] += x * ux
                blocks[m, 0, 1] += x * uy
                blocks[m, 0, 2] += x * uz
                blocks[m, 1, 0] += y * ux
                blocks[m, 1, 1] += y * uy
                blocks[m, 1, 2] += y * uz
                blocks[m, 2, 0] += z * ux
                blocks[m, 2, 1] += z * uy
                blocks[m, 2, 2] += z * uz

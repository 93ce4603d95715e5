"""The point of a drawn mesh at a pixel, as shares of its face's vertices."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def barycentric_into(barycentric, face_vertices, projected, column, row):
    """Write the perspective-correct shares (3,) of a face's vertices at a pixel inside it.

    Args:
        barycentric: (3,) out, sums to one.
        face_vertices: (3,) vertex ids.
        projected: (V, 3) column px, row px, inverse depth 1/m.
        column: px.
        row: px.
    """
    a, b, c = face_vertices[0], face_vertices[1], face_vertices[2]
    xa, ya, xb, yb, xc, yc = (
        projected[a, 0],
        projected[a, 1],
        projected[b, 0],
        projected[b, 1],
        projected[c, 0],
        projected[c, 1],
    )
    area = (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa)
    wb = ((column - xa) * (yc - ya) - (row - ya) * (xc - xa)) / area
    wc = ((xb - xa) * (row - ya) - (yb - ya) * (column - xa)) / area
    wa = (1.0 - wb - wc) * projected[a, 2]
    wb *= projected[b, 2]
    wc *= projected[c, 2]
    total = wa + wb + wc
    barycentric[0], barycentric[1], barycentric[2] = wa / total, wb / total, wc / total


@njit(cache=True, nogil=True)
def find_shares(ids, projected, columns, rows):
    """(N, 3) the shares of the vertices (N, 3) of faces at pixels inside them; columns and rows (N,) px."""
    shares = np.empty((len(ids), 3))
    for n in range(len(ids)):
        barycentric_into(shares[n], ids[n], projected, columns[n], rows[n])
    return shares

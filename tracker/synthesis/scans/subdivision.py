"""Loop's subdivision of a triangle mesh as a matrix, with his rule for open borders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix, csr_matrix

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Subdivision:
    """One step.

    Attributes:
        matrix: (V', V) new vertices from old ones; the first V are the old ones, moved.
        faces: (4 F, 3).
    """

    matrix: csr_matrix
    faces: Ints

    @property
    def size(self) -> int:
        """Number of new vertices, V'."""
        return int(self.faces.max()) + 1


def subdivide(faces: Ints, num_vertices: int) -> Subdivision:
    """One step of Loop's scheme (Loop 1987, with Warren's weights) for faces (F, 3)."""
    half = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    opposite = np.concatenate([faces[:, 2], faces[:, 0], faces[:, 1]])
    edges, edge_of_half, counts = np.unique(np.sort(half, axis=1), axis=0, return_inverse=True, return_counts=True)
    edge_of_half = edge_of_half.ravel()
    assert counts.max() <= 2, "an edge has more than two faces"
    is_border = counts == 1
    rows, columns, values = [], [], []

    def add(row: Ints, column: Ints, value: Array) -> None:
        rows.append(row)
        columns.append(column)
        values.append(np.broadcast_to(value, row.shape))

    # New vertices on the edges: 3/8 of the ends and 1/8 of the two opposite corners; the middle on a border.
    numbers = num_vertices + np.arange(len(edges))
    share = np.where(is_border, 0.5, 0.375)
    add(numbers, edges[:, 0], share)
    add(numbers, edges[:, 1], share)
    inner = ~is_border[edge_of_half]
    add(num_vertices + edge_of_half[inner], opposite[inner], np.array(0.125))

    # Old vertices: (1 - n b) of themselves and b of each neighbour; 3/4 and 1/8 along a border.
    on_border = np.zeros(num_vertices, dtype=bool)
    on_border[edges[is_border].ravel()] = True
    valence = np.bincount(edges.ravel(), minlength=num_vertices)
    beta = np.where(valence == 3, 3.0 / 16.0, 3.0 / (8.0 * np.maximum(valence, 1)))
    old = np.arange(num_vertices)
    add(old, old, np.where(on_border, 0.75, 1.0 - valence * beta))
    for a, b in ((0, 1), (1, 0)):
        free = ~on_border[edges[:, a]]
        add(edges[free, a], edges[free, b], beta[edges[free, a]])
        add(edges[is_border, a], edges[is_border, b], np.array(0.125))

    size = (num_vertices + len(edges), num_vertices)
    triplets = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    a, b, c = faces.T
    ab, bc, ca = num_vertices + edge_of_half.reshape(3, -1)
    split = np.stack([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]])
    return Subdivision(csr_matrix(coo_matrix(triplets, shape=size)), split.transpose(2, 0, 1).reshape(-1, 3))

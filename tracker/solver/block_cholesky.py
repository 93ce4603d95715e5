"""Sparse Cholesky factor of a symmetric matrix of 3 x 3 blocks whose pattern stays the same."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy import sparse
from scipy.sparse.linalg import splu

from tracker.errors import SolveError

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class BlockPattern(NamedTuple):
    """Where the blocks of the factor lie; nodes are numbered in the order of elimination.

    order (N,) node eliminated k-th; rank (N,) its inverse; starts (N + 1,) columns of the factor, each beginning with
    its diagonal; rows (M,) of each block; row_starts (N + 1,), row_columns and row_blocks (M - N,) the same blocks
    below the diagonal, by rows.
    """

    order: Ints
    rank: Ints
    starts: Ints
    rows: Ints
    row_starts: Ints
    row_columns: Ints
    row_blocks: Ints


def find_block_pattern(num_nodes: int, edges: Ints) -> BlockPattern:
    """Order the nodes for little fill (minimum degree) and find the pattern of the factor.

    Args:
        num_nodes: N.
        edges: (E, 2) pairs of different nodes whose block is not zero.
    """
    ones = np.ones(2 * len(edges))
    ends = np.concatenate([edges, edges[:, ::-1]])
    graph = sparse.csc_matrix((ones, (ends[:, 0], ends[:, 1])), (num_nodes, num_nodes))
    graph = (graph + 50.0 * num_nodes * sparse.eye(num_nodes)).tocsc()
    factor = splu(graph, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    order = np.argsort(factor.perm_c).astype(np.int64)
    rank = np.empty(num_nodes, dtype=np.int64)
    rank[order] = np.arange(num_nodes)
    columns: list[set[int]] = [set() for _ in range(num_nodes)]
    for a, b in rank[edges]:
        columns[min(a, b)].add(int(max(a, b)))
    for column in range(num_nodes):
        below = columns[column]
        if below:
            parent = min(below)
            columns[parent] |= below - {parent}
    starts = np.concatenate([[0], np.cumsum([1 + len(column) for column in columns])]).astype(np.int64)
    rows = np.concatenate([np.array([k, *sorted(column)]) for k, column in enumerate(columns)]).astype(np.int64)
    owner = np.repeat(np.arange(num_nodes), np.diff(starts))
    below = np.flatnonzero(rows != owner)
    by_row = below[np.lexsort((owner[below], rows[below]))]
    row_starts = np.concatenate([[0], np.cumsum(np.bincount(rows[below], minlength=num_nodes))]).astype(np.int64)
    return BlockPattern(order, rank, starts, rows, row_starts, owner[by_row].astype(np.int64), by_row.astype(np.int64))


def find_block(pattern: BlockPattern, a: Ints, b: Ints) -> tuple[Ints, npt.NDArray[np.bool_]]:
    """Places (K,) of the blocks of nodes a and b (K,), and whether each holds the transpose, its row being b's."""
    i, j = pattern.rank[a], pattern.rank[b]
    low, high = np.minimum(i, j), np.maximum(i, j)
    owner = np.repeat(np.arange(len(pattern.order)), np.diff(pattern.starts))
    keys = owner * len(pattern.order) + pattern.rows
    return np.searchsorted(keys, low * len(pattern.order) + high), i < j


def factorize(pattern: BlockPattern, blocks: Array) -> Array:
    """Cholesky factor (M, 3, 3) of the matrix whose lower blocks (M, 3, 3) lie as in the pattern.

    Raises:
        SolveError: The matrix is not positive definite.
    """
    factor = blocks.copy()
    if not _factorize(factor, *pattern[2:]):
        raise SolveError("The equations of the free surface have no minimum; needed points and a coupling above 0.")
    return factor


def solve_lower(pattern: BlockPattern, factor: Array, right: Array) -> Array:
    """L⁻¹ B for B (N, 3, K), nodes in the order of elimination."""
    solution = np.ascontiguousarray(right, dtype=np.float64).copy()
    _solve_lower(factor, pattern.starts, pattern.rows, solution)
    return solution


def solve_upper(pattern: BlockPattern, factor: Array, right: Array) -> Array:
    """L⁻ᵀ b for b (N, 3), nodes in the order of elimination."""
    solution = np.ascontiguousarray(right, dtype=np.float64).copy()
    _solve_upper(factor, pattern.starts, pattern.rows, solution)
    return solution


@njit(cache=True, nogil=True)
def _factorize(L, starts, rows, row_starts, row_columns, row_blocks):
    num_nodes = len(starts) - 1
    place = np.zeros(num_nodes, dtype=np.int64)
    for j in range(num_nodes):
        for m in range(starts[j], starts[j + 1]):
            place[rows[m]] = m
        for k in range(row_starts[j], row_starts[j + 1]):
            column, block = row_columns[k], row_blocks[k]
            a00, a01, a02 = L[block, 0, 0], L[block, 0, 1], L[block, 0, 2]
            a10, a11, a12 = L[block, 1, 0], L[block, 1, 1], L[block, 1, 2]
            a20, a21, a22 = L[block, 2, 0], L[block, 2, 1], L[block, 2, 2]
            for m in range(block, starts[column + 1]):
                into = place[rows[m]]
                for r in range(3):
                    x, y, z = L[m, r, 0], L[m, r, 1], L[m, r, 2]
                    L[into, r, 0] -= x * a00 + y * a01 + z * a02
                    L[into, r, 1] -= x * a10 + y * a11 + z * a12
                    L[into, r, 2] -= x * a20 + y * a21 + z * a22
        d = starts[j]
        if not L[d, 0, 0] > 0.0:
            return False
        l00 = np.sqrt(L[d, 0, 0])
        l10, l20 = L[d, 1, 0] / l00, L[d, 2, 0] / l00
        rest = L[d, 1, 1] - l10 * l10
        if not rest > 0.0:
            return False
        l11 = np.sqrt(rest)
        l21 = (L[d, 2, 1] - l20 * l10) / l11
        rest = L[d, 2, 2] - l20 * l20 - l21 * l21
        if not rest > 0.0:
            return False
        l22 = np.sqrt(rest)
        L[d, 0, 0], L[d, 0, 1], L[d, 0, 2] = l00, 0.0, 0.0
        L[d, 1, 0], L[d, 1, 1], L[d, 1, 2] = l10, l11, 0.0
        L[d, 2, 0], L[d, 2, 1], L[d, 2, 2] = l20, l21, l22
        for m in range(d + 1, starts[j + 1]):
            for r in range(3):
                x = L[m, r, 0] / l00
                y = (L[m, r, 1] - x * l10) / l11
                L[m, r, 0], L[m, r, 1] = x, y
                L[m, r, 2] = (L[m, r, 2] - x * l20 - y * l21) / l22
    return True


@njit(cache=True, nogil=True, fastmath={"contract"})
def _solve_lower(L, starts, rows, b):
    width = b.shape[2]
    for j in range(len(starts) - 1):
        d = starts[j]
        l00, l10, l20, l11, l21, l22 = L[d, 0, 0], L[d, 1, 0], L[d, 2, 0], L[d, 1, 1], L[d, 2, 1], L[d, 2, 2]
        for k in range(width):
            x = b[j, 0, k] / l00
            y = (b[j, 1, k] - l10 * x) / l11
            b[j, 0, k], b[j, 1, k] = x, y
            b[j, 2, k] = (b[j, 2, k] - l20 * x - l21 * y) / l22
        for m in range(d + 1, starts[j + 1]):
            i = rows[m]
            for r in range(3):
                x, y, z = L[m, r, 0], L[m, r, 1], L[m, r, 2]
                for k in range(width):
                    b[i, r, k] -= x * b[j, 0, k] + y * b[j, 1, k] + z * b[j, 2, k]


@njit(cache=True, nogil=True)
def _solve_upper(L, starts, rows, b):
    for j in range(len(starts) - 2, -1, -1):
        d = starts[j]
        x, y, z = b[j, 0], b[j, 1], b[j, 2]
        for m in range(d + 1, starts[j + 1]):
            i = rows[m]
            p, q, r = b[i, 0], b[i, 1], b[i, 2]
            x -= L[m, 0, 0] * p + L[m, 1, 0] * q + L[m, 2, 0] * r
            y -= L[m, 0, 1] * p + L[m, 1, 1] * q + L[m, 2, 1] * r
            z -= L[m, 0, 2] * p + L[m, 1, 2] * q + L[m, 2, 2] * r
        z /= L[d, 2, 2]
        y = (y - L[d, 2, 1] * z) / L[d, 1, 1]
        b[j, 0], b[j, 1], b[j, 2] = (x - L[d, 1, 0] * y - L[d, 2, 0] * z) / L[d, 0, 0], y, z

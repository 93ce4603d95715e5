"""A hierarchy of boxes over the triangles of moving parts: built once, refitted at every pose."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

LEAF_TRIANGLES = 8
"""A node with so few triangles is not divided further."""


class TriangleTree(NamedTuple):
    """One binary tree per group of triangles, all in one list of nodes in preorder.

    The first child of a node n follows it, the second is `skip[n + 1]`; n is a leaf where `skip[n]` is n + 1.

    order (F,) triangles, those of a node side by side; starts and ends (N,) a node's range of them; skip (N,) the node
    after the node's whole tree; roots (G,) -1 for a group without triangles; groups (F,) of each triangle.
    """

    order: Ints
    starts: Ints
    ends: Ints
    skip: Ints
    roots: Ints
    groups: Ints


class Filter(NamedTuple):
    """Who may meet whom.

    groups: (G, G) whether a part of the first group may meet one of the second; never within a group.
    triangles: (F, G) whether a triangle may meet triangles of a group.
    """

    groups: npt.NDArray[np.bool_]
    triangles: npt.NDArray[np.bool_]


class FittedTree(NamedTuple):
    """A tree with its triangles where they are now.

    tree; allowed; boxes (lowest x, y, z, highest x, y, z) of nodes (N, 6) and triangles (F, 6), m; vertices (V, 3) m;
    faces (F, 3).
    """

    tree: TriangleTree
    allowed: Filter
    node_boxes: Array
    triangle_boxes: Array
    vertices: Array
    faces: Ints


def build_triangle_tree(centroids: Array, groups: Ints, num_groups: int) -> TriangleTree:
    """Halve each group along its longest side until LEAF_TRIANGLES are left.

    Args:
        centroids: (F, 3) of the triangles at rest, m.
        groups: (F,) below `num_groups`, such as the bone that a triangle follows most.
        num_groups: G.
    """
    order: list[int] = []
    starts: list[int] = []
    ends: list[int] = []
    skip: list[int] = []

    def add(triangles: npt.NDArray[np.intp]) -> None:
        node = len(starts)
        starts.append(len(order))
        ends.append(len(order) + len(triangles))
        skip.append(-1)
        if len(triangles) <= LEAF_TRIANGLES:
            order.extend(int(t) for t in triangles)
        else:
            points = centroids[triangles]
            axis = int(np.argmax(np.ptp(points, axis=0)))
            sorted_triangles = triangles[np.argsort(points[:, axis], kind="stable")]
            half = len(triangles) // 2
            add(sorted_triangles[:half])
            add(sorted_triangles[half:])
        skip[node] = len(starts)

    roots = np.full(num_groups, -1, dtype=np.int32)
    for group in range(num_groups):
        members = np.flatnonzero(groups == group)
        if len(members):
            roots[group] = len(starts)
            add(members)
    return TriangleTree(
        order=np.array(order, dtype=np.int32),
        starts=np.array(starts, dtype=np.int32),
        ends=np.array(ends, dtype=np.int32),
        skip=np.array(skip, dtype=np.int32),
        roots=roots,
        groups=np.ascontiguousarray(groups, dtype=np.int32),
    )


def fit_tree(tree: TriangleTree, allowed: Filter, vertices: Array, faces: Ints) -> FittedTree:
    """The tree with its triangles at vertices (V, 3), m, faces (F, 3)."""
    fitted = FittedTree(tree, allowed, np.empty((len(tree.starts), 6)), np.empty((len(faces), 6)), vertices, faces)
    _fit_into(fitted.node_boxes, fitted.triangle_boxes, tree.order, tree.starts, tree.ends, tree.skip, vertices, faces)
    return fitted


@njit(cache=True, nogil=True)
def _fit_into(nodes, triangles, order, starts, ends, skip, vertices, faces):
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        for axis in range(3):
            p, q, r = vertices[a, axis], vertices[b, axis], vertices[c, axis]
            triangles[f, axis] = min(p, q, r)
            triangles[f, 3 + axis] = max(p, q, r)
    for node in range(len(starts) - 1, -1, -1):
        if skip[node] == node + 1:
            _copy(nodes, node, triangles, order[starts[node]])
            for place in range(starts[node] + 1, ends[node]):
                _grow(nodes, node, triangles, order[place])
        else:
            _copy(nodes, node, nodes, node + 1)
            _grow(nodes, node, nodes, skip[node + 1])


@njit(cache=True, nogil=True)
def _copy(boxes, a, others, b):
    for side in range(6):
        boxes[a, side] = others[b, side]


@njit(cache=True, nogil=True)
def _grow(boxes, a, others, b):
    for axis in range(3):
        boxes[a, axis] = min(boxes[a, axis], others[b, axis])
        boxes[a, 3 + axis] = max(boxes[a, 3 + axis], others[b, 3 + axis])

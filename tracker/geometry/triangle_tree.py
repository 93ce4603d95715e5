"""A hierarchy of boxes over the triangles of moving parts: built once, refitted at every pose."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.geometry.triangles import compute_squared_distance, do_triangles_cross, meet_line

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

LEAF_TRIANGLES = 8
"""A node with so few triangles is not divided further."""

MAX_STACK = 128
"""Pairs of nodes that wait during a descent; far above twice the depth of a tree halved at every node."""


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


class Boxes(NamedTuple):
    """Axis-aligned boxes (lowest x, y, z, highest x, y, z) of nodes (N, 6) and triangles (F, 6), m."""

    nodes: Array
    triangles: Array


class Filter(NamedTuple):
    """Who may meet whom.

    groups: (G, G) whether a part of the first group may meet one of the second; never within a group.
    triangles: (F, G) whether a triangle may meet triangles of a group.
    """

    groups: npt.NDArray[np.bool_]
    triangles: npt.NDArray[np.bool_]


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


def fit_boxes(tree: TriangleTree, vertices: Array, faces: Ints) -> Boxes:
    """The boxes of a tree with its triangles where they are now: vertices (V, 3) m, faces (F, 3)."""
    boxes = Boxes(np.empty((len(tree.starts), 6)), np.empty((len(faces), 6)))
    _fit_into(boxes.nodes, boxes.triangles, tree.order, tree.starts, tree.ends, tree.skip, vertices, faces)
    return boxes


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


@njit(cache=True, nogil=True)
def _do_boxes_meet(boxes, a, others, b):
    """Without branches, which nobody could foresee: three times as fast as with `and`."""
    return (
        (boxes[a, 0] <= others[b, 3])
        & (others[b, 0] <= boxes[a, 3])
        & (boxes[a, 1] <= others[b, 4])
        & (others[b, 1] <= boxes[a, 4])
        & (boxes[a, 2] <= others[b, 5])
        & (others[b, 2] <= boxes[a, 5])
    )


@njit(cache=True, nogil=True)
def find_crossings_into(pairs, tree, boxes, allowed, vertices, faces):
    """Write the crossing pairs of triangles that may meet, and return their number.

    A number above len(pairs) means that only the first len(pairs) were written. Triangles with a common vertex never
    cross. The order of the pairs depends on the tree alone.

    Args:
        pairs: (C, 2) out.
        tree: TriangleTree.
        boxes: Boxes of the tree, fitted.
        allowed: Filter.
        vertices: (V, 3) m.
        faces: (F, 3).
    """
    order, starts, ends, skip, roots = tree.order, tree.starts, tree.ends, tree.skip, tree.roots
    nodes, triangles = boxes.nodes, boxes.triangles
    groups_may_meet, may_meet = allowed.groups, allowed.triangles
    stack = np.empty((MAX_STACK, 2), dtype=np.int32)
    count = 0
    for first in range(len(roots)):
        for second in range(first + 1, len(roots)):
            if roots[first] < 0 or roots[second] < 0 or not groups_may_meet[first, second]:
                continue
            stack[0, 0], stack[0, 1] = roots[first], roots[second]
            waiting = 1
            while waiting > 0:
                waiting -= 1
                a, b = stack[waiting, 0], stack[waiting, 1]
                if not _do_boxes_meet(nodes, a, nodes, b):
                    continue
                is_leaf_a, is_leaf_b = skip[a] == a + 1, skip[b] == b + 1
                if is_leaf_a and is_leaf_b:
                    for i in range(starts[a], ends[a]):
                        f = order[i]
                        if not may_meet[f, second] or not _do_boxes_meet(triangles, f, nodes, b):
                            continue
                        for j in range(starts[b], ends[b]):
                            g = order[j]
                            if (
                                _do_boxes_meet(triangles, f, triangles, g)
                                and may_meet[g, first]
                                and not _share_vertex(faces, f, g)
                                and do_triangles_cross(vertices, faces, f, g)
                            ):
                                if count < len(pairs):
                                    pairs[count, 0], pairs[count, 1] = f, g
                                count += 1
                elif is_leaf_b or (not is_leaf_a and ends[a] - starts[a] >= ends[b] - starts[b]):
                    stack[waiting, 0], stack[waiting, 1] = a + 1, b
                    stack[waiting + 1, 0], stack[waiting + 1, 1] = skip[a + 1], b
                    waiting += 2
                else:
                    stack[waiting, 0], stack[waiting, 1] = a, b + 1
                    stack[waiting + 1, 0], stack[waiting + 1, 1] = a, skip[b + 1]
                    waiting += 2
    return count


@njit(cache=True, nogil=True)
def _share_vertex(faces, f, g):
    a, b, c = faces[g, 0], faces[g, 1], faces[g, 2]
    for corner in range(3):
        vertex = faces[f, corner]
        if (vertex == a) | (vertex == b) | (vertex == c):
            return True
    return False


@njit(cache=True, nogil=True)
def find_exits(tree, boxes, allowed, may_meet, own, start, stop, vertices, faces, point, direction):
    """Where the line through a point leaves the groups start..stop - 1, if the point is inside them.

    The point is inside when the first surface on the line is met from within both ahead and behind. For a closed
    surface that does not cross itself one side would decide; asking both makes the open end of a limb harmless.

    Args:
        tree: TriangleTree.
        boxes: Boxes of the tree, fitted.
        allowed: Filter.
        may_meet: (G,) groups that count.
        own: Group of the point: triangles that may not meet it are passed through.
        start: First group.
        stop: One after the last group.
        vertices: (V, 3) m.
        faces: (F, 3).
        point: (3,) m.
        direction: (3,) unit.

    Returns:
        Triangle behind (-1 = not inside), distance to it, m, cosine of the way there with its normal, distance ahead.
    """
    _, ahead, cosine_ahead = _find_first(
        tree, boxes, allowed, may_meet, own, start, stop, vertices, faces, point, direction, 1.0
    )
    if cosine_ahead <= 0.0:
        return -1, 0.0, 0.0, 0.0
    triangle, behind, cosine = _find_first(
        tree, boxes, allowed, may_meet, own, start, stop, vertices, faces, point, direction, -1.0
    )
    if cosine <= 0.0:
        return -1, 0.0, 0.0, 0.0
    return triangle, behind, cosine, ahead


@njit(cache=True, nogil=True)
def _find_first(tree, boxes, allowed, may_meet, own, start, stop, vertices, faces, point, direction, sign):
    """Triangle that a ray meets first, how far away, and the cosine between them: positive from within, 0 if none."""
    order, starts, ends, skip, roots = tree.order, tree.starts, tree.ends, tree.skip, tree.roots
    nodes, triangle_may_meet = boxes.nodes, allowed.triangles
    x, y, z = point[0], point[1], point[2]
    dx, dy, dz = sign * direction[0], sign * direction[1], sign * direction[2]
    ix, iy, iz = _invert(dx), _invert(dy), _invert(dz)
    nearest, cosine = np.inf, 0.0
    triangle = -1
    for group in range(start, stop):
        if roots[group] < 0 or not may_meet[group]:
            continue
        node = roots[group]
        end = skip[node]
        while node < end:
            if not _does_ray_meet_box(nodes, node, x, y, z, ix, iy, iz, nearest):
                node = skip[node]
                continue
            if skip[node] == node + 1:
                for place in range(starts[node], ends[node]):
                    f = order[place]
                    if not triangle_may_meet[f, own]:
                        continue
                    along, slope = meet_line(vertices, faces, f, x, y, z, dx, dy, dz)
                    if slope != 0.0 and 0.0 <= along < nearest:
                        nearest, cosine, triangle = along, slope, f
            node += 1
    return triangle, nearest, cosine


@njit(cache=True, nogil=True)
def _invert(slope):
    return 1.0 / slope if abs(slope) > 1e-12 else 1e12


@njit(cache=True, nogil=True)
def _does_ray_meet_box(boxes, node, x, y, z, ix, iy, iz, far):
    """Whether the first `far` metres of a ray enter a box; (ix, iy, iz) is one over its direction."""
    x0, x1 = (boxes[node, 0] - x) * ix, (boxes[node, 3] - x) * ix
    y0, y1 = (boxes[node, 1] - y) * iy, (boxes[node, 4] - y) * iy
    z0, z1 = (boxes[node, 2] - z) * iz, (boxes[node, 5] - z) * iz
    near = max(0.0, min(x0, x1), min(y0, y1), min(z0, z1))
    return near <= min(far, max(x0, x1), max(y0, y1), max(z0, z1))


@njit(cache=True, nogil=True)
def find_distance(tree, boxes, allowed, may_meet, own, start, stop, vertices, faces, point):
    """Distance, m, from a point to the nearest triangle of groups start..stop - 1; arguments as in `find_exits`."""
    x, y, z = point[0], point[1], point[2]
    best = np.inf
    for group in range(start, stop):
        if tree.roots[group] < 0 or not may_meet[group]:
            continue
        node = tree.roots[group]
        end = tree.skip[node]
        while node < end:
            gap = 0.0
            for axis in range(3):
                outside = max(boxes.nodes[node, axis] - point[axis], point[axis] - boxes.nodes[node, 3 + axis], 0.0)
                gap += outside * outside
            if gap >= best:
                node = tree.skip[node]
                continue
            if tree.skip[node] == node + 1:
                for place in range(tree.starts[node], tree.ends[node]):
                    f = tree.order[place]
                    if allowed.triangles[f, own]:
                        best = min(best, compute_squared_distance(vertices, faces, f, x, y, z))
            node += 1
    return np.sqrt(best)

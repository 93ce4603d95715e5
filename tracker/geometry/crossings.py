"""Which triangles of different parts cross: two trees descended together."""

from __future__ import annotations

import numpy as np
from numba import njit

from tracker.geometry.triangles import do_triangles_cross

MAX_STACK = 128
"""Pairs of nodes that wait during a descent; far above twice the depth of a tree halved at every node."""


@njit(cache=True, nogil=True)
def _do_boxes_meet(boxes, a, others, b):
    """Without branches, which cannot be predicted: three times as fast as with `and`."""
    return (
        (boxes[a, 0] <= others[b, 3])
        & (others[b, 0] <= boxes[a, 3])
        & (boxes[a, 1] <= others[b, 4])
        & (others[b, 1] <= boxes[a, 4])
        & (boxes[a, 2] <= others[b, 5])
        & (others[b, 2] <= boxes[a, 5])
    )


@njit(cache=True, nogil=True)
def find_crossings_into(pairs, fitted):
    """Write the crossing pairs of triangles that may meet, and return their number.

    A number above len(pairs) means that only the first len(pairs) were written. Triangles with a common vertex never
    cross. The order of the pairs depends on the tree alone.

    Args:
        pairs: (C, 2) out.
        fitted: FittedTree.
    """
    order, starts, ends = fitted.tree.order, fitted.tree.starts, fitted.tree.ends
    skip, roots = fitted.tree.skip, fitted.tree.roots
    nodes, triangles = fitted.node_boxes, fitted.triangle_boxes
    groups_may_meet, may_meet = fitted.allowed.groups, fitted.allowed.triangles
    vertices, faces = fitted.vertices, fitted.faces
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

"""Where a point inside moving parts would leave them, and how deep inside it is."""

from __future__ import annotations

import numpy as np
from numba import njit

from tracker.geometry.triangles import find_closest, meet_line


@njit(cache=True, nogil=True)
def find_exits(fitted, may_meet, own, start, stop, point, direction):
    """Where the line through a point leaves the groups start..stop - 1, if the point is inside them.

    The point is inside when the first surface on the line is met from within both ahead and behind. For a closed
    surface that does not cross itself one side would decide; asking both makes the open end of a limb harmless.

    Args:
        fitted: FittedTree.
        may_meet: (G,) groups that count.
        own: Group of the point: triangles that may not meet it are passed through.
        start: First group.
        stop: One after the last group.
        point: (3,) m.
        direction: (3,) unit.

    Returns:
        Triangle behind (-1 = not inside), distance to it, m, cosine of the way there with its normal, distance ahead.
    """
    _, ahead, cosine_ahead = _find_first(fitted, may_meet, own, start, stop, point, direction, 1.0)
    if cosine_ahead <= 0.0:
        return -1, 0.0, 0.0, 0.0
    triangle, behind, cosine = _find_first(fitted, may_meet, own, start, stop, point, direction, -1.0)
    if cosine <= 0.0:
        return -1, 0.0, 0.0, 0.0
    return triangle, behind, cosine, ahead


@njit(cache=True, nogil=True)
def _find_first(fitted, may_meet, own, start, stop, point, direction, sign):
    """Triangle that a ray meets first, how far away, and the cosine between them: positive from within, 0 if none."""
    order, starts, ends = fitted.tree.order, fitted.tree.starts, fitted.tree.ends
    skip, roots = fitted.tree.skip, fitted.tree.roots
    boxes, triangle_may_meet = fitted.node_boxes, fitted.allowed.triangles
    vertices, faces = fitted.vertices, fitted.faces
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
            if not _does_ray_meet_box(boxes, node, x, y, z, ix, iy, iz, nearest):
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
def count_windings(fitted, start, stop, point, direction, vertex):
    """How many times the surface of groups start..stop - 1 encloses a point: exits less entries along a ray.

    Every triangle counts, allowed or not, but those with the given vertex: for a vertex of the surface itself it is
    the place just outside that is asked about. Exact for closed surfaces, also where they cross themselves.

    Args:
        fitted: FittedTree.
        start: First group.
        stop: One after the last group.
        point: (3,) m.
        direction: (3,).
        vertex: Whose triangles are left out.
    """
    order, starts, ends = fitted.tree.order, fitted.tree.starts, fitted.tree.ends
    skip, roots, boxes = fitted.tree.skip, fitted.tree.roots, fitted.node_boxes
    vertices, faces = fitted.vertices, fitted.faces
    x, y, z = point[0], point[1], point[2]
    # a little askew: normals of regular shapes point right at edges, where one crossing would count twice
    dx, dy, dz = direction[0] + 1.13e-4, direction[1] - 0.71e-4, direction[2] + 0.93e-4
    ix, iy, iz = _invert(dx), _invert(dy), _invert(dz)
    windings = 0
    for group in range(start, stop):
        if roots[group] < 0:
            continue
        node = roots[group]
        end = skip[node]
        while node < end:
            if not _does_ray_meet_box(boxes, node, x, y, z, ix, iy, iz, np.inf):
                node = skip[node]
                continue
            if skip[node] == node + 1:
                for place in range(starts[node], ends[node]):
                    f = order[place]
                    if (faces[f, 0] == vertex) | (faces[f, 1] == vertex) | (faces[f, 2] == vertex):
                        continue
                    along, slope = meet_line(vertices, faces, f, x, y, z, dx, dy, dz)
                    if slope != 0.0 and along > 0.0:
                        windings += 1 if slope > 0.0 else -1
            node += 1
    return windings


@njit(cache=True, nogil=True)
def find_distance(fitted, may_meet, own, start, stop, point):
    """Distance, m, from a point to the nearest triangle of groups start..stop - 1; arguments as in `find_exits`."""
    order, starts, ends = fitted.tree.order, fitted.tree.starts, fitted.tree.ends
    skip, roots = fitted.tree.skip, fitted.tree.roots
    boxes, triangle_may_meet = fitted.node_boxes, fitted.allowed.triangles
    vertices, faces = fitted.vertices, fitted.faces
    best = np.inf
    for group in range(start, stop):
        if roots[group] < 0 or not may_meet[group]:
            continue
        node = roots[group]
        end = skip[node]
        while node < end:
            gap = 0.0
            for axis in range(3):
                outside = max(boxes[node, axis] - point[axis], point[axis] - boxes[node, 3 + axis], 0.0)
                gap += outside * outside
            if gap >= best:
                node = skip[node]
                continue
            if skip[node] == node + 1:
                for place in range(starts[node], ends[node]):
                    f = order[place]
                    if triangle_may_meet[f, own]:
                        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
                        best = min(best, find_closest(point[0], point[1], point[2], vertices, a, b, c)[0])
            node += 1
    return np.sqrt(best)

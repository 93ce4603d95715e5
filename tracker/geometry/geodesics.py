"""Exact geodesic distances on a triangle mesh, by windows carried over its edges.

A window is the part of an edge that straight lines from one source reach after the faces between are laid flat. It is
carried from edge to edge, nearest first, and dropped where a path through one of the face's corners is shorter
(S.-Q. Xin and G.-J. Wang, "Improving Chen and Han's algorithm on the discrete geodesic problem", ACM TOG 28, 2009).
At boundary vertices and at vertices with more than a full turn of angle around them shortest paths may bend: they are
sources of their own. Distances are exact up to rounding.
"""

from __future__ import annotations

import heapq

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


def compute_geodesics(vertices: Array, faces: Integers, sources: Integers) -> Array:
    """Distances along the surface.

    Args:
        vertices: (V, 3), any unit.
        faces: (F, 3), a manifold with or without boundary, consistently turned.
        sources: (S,) vertex ids.

    Returns:
        (S, V) in the unit of `vertices`; inf where no path leads.
    """
    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    faces = np.ascontiguousarray(faces, dtype=np.int64)
    assert vertices.ndim == 2 and vertices.shape[1] == 3 and faces.ndim == 2 and faces.shape[1] == 3
    twins = _find_twins(faces)
    starts, corners = _list_corners(faces, len(vertices))
    bends = _find_bends(vertices, faces, twins)
    distances = np.empty((len(sources), len(vertices)))
    for row, source in enumerate(sources):
        _spread(vertices, faces, twins, starts, corners, bends, int(source), distances[row])
    return distances


def _find_twins(faces: Integers) -> Integers:
    """(3F,) the other side of half-edge 3f+k, which runs from corner k of face f to the next; -1 at a boundary."""
    ends = {(int(face[k]), int(face[(k + 1) % 3])): 3 * f + k for f, face in enumerate(faces) for k in range(3)}
    assert len(ends) == faces.size, "two faces run along an edge in the same direction"
    return np.array(
        [ends.get((int(face[(k + 1) % 3]), int(face[k])), -1) for face in faces for k in range(3)], dtype=np.int64
    )


def _list_corners(faces: Integers, num_vertices: int) -> tuple[Integers, Integers]:
    """Corners 3f+k by vertex: those of vertex v are `corners[starts[v]:starts[v + 1]]`."""
    corners = np.argsort(faces.ravel(), kind="stable")
    starts = np.searchsorted(faces.ravel()[corners], np.arange(num_vertices + 1))
    return starts, corners


def _find_bends(vertices: Array, faces: Integers, twins: Integers) -> npt.NDArray[np.bool_]:
    """(V,) whether shortest paths may pass through a vertex."""
    turn = np.zeros(len(vertices))
    for k in range(3):
        a, b = (vertices[faces[:, (k + step) % 3]] - vertices[faces[:, k]] for step in (1, 2))
        cosine = (a * b).sum(1) / np.maximum(np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1), 1e-300)
        np.add.at(turn, faces[:, k], np.arccos(np.clip(cosine, -1.0, 1.0)))
    bends = turn > 2.0 * np.pi - 1e-9
    boundary = np.flatnonzero(twins < 0)
    bends[faces.ravel()[boundary]] = True
    bends[faces[boundary // 3, (boundary % 3 + 1) % 3]] = True
    return bends


@njit(cache=True, nogil=True)
def _length(vertices, a, b):
    x, y, z = vertices[a, 0] - vertices[b, 0], vertices[a, 1] - vertices[b, 1], vertices[a, 2] - vertices[b, 2]
    return np.sqrt(x * x + y * y + z * z)


@njit(cache=True, nogil=True)
def _lay_flat(length, to_first, to_second):
    """Where a point lies that is so far from both ends of an edge from (0, 0) to (length, 0): (x, y >= 0)."""
    x = (length * length + to_first * to_first - to_second * to_second) / (2.0 * length)
    return x, np.sqrt(max(0.0, to_first * to_first - x * x))


@njit(cache=True, nogil=True)
def _spread(vertices, faces, twins, starts, corners, bends, source, distances):
    distances[:] = np.inf
    distances[source] = 0.0
    # (distance, half-edge of the face to enter, or -1-v: vertex v; start, end, x, y of the source laid flat; its own)
    heap = [(0.0, -1 - source, 0.0, 0.0, 0.0, 0.0, 0.0)]
    while heap:
        key, h, low, high, x, y, before = heapq.heappop(heap)
        if h < 0:
            v = -1 - h
            if key <= distances[v]:
                _leave_vertex(vertices, faces, twins, starts, corners, bends, v, distances, heap)
        else:
            _cross_face(vertices, faces, twins, bends, h, low, high, x, y, before, distances, heap)


@njit(cache=True, nogil=True)
def _reach(v, distance, bends, distances, heap):
    if distance < distances[v]:
        distances[v] = distance
        if bends[v]:
            heapq.heappush(heap, (distance, -1 - v, 0.0, 0.0, 0.0, 0.0, 0.0))


@njit(cache=True, nogil=True)
def _leave_vertex(vertices, faces, twins, starts, corners, bends, v, distances, heap):
    """Edges at v carry paths to their other ends; faces at v let it see the whole opposite edge."""
    so_far = distances[v]
    for place in range(starts[v], starts[v + 1]):
        f, k = corners[place] // 3, corners[place] % 3
        a, b = faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
        to_a, to_b = _length(vertices, v, a), _length(vertices, v, b)
        _reach(a, so_far + to_a, bends, distances, heap)
        _reach(b, so_far + to_b, bends, distances, heap)
        twin = twins[3 * f + (k + 1) % 3]
        if twin >= 0:
            length = _length(vertices, a, b)
            x, y = _lay_flat(length, to_b, to_a)  # the twin runs from b to a
            nearest = y if 0.0 < x < length else min(to_a, to_b)
            heapq.heappush(heap, (so_far + nearest, twin, 0.0, length, x, y, so_far))


@njit(cache=True, nogil=True)
def _cross_face(vertices, faces, twins, bends, h, low, high, x, y, before, distances, heap):
    """Carry the window [low, high] of half-edge h into its face: to the apex, and on to the two other edges.

    The edge runs along +x from 0; the apex lies at y > 0, the source at (x, -y).
    """
    f, k = h // 3, h % 3
    first, second, apex = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
    length = _length(vertices, first, second)
    from_first, from_second = _length(vertices, first, apex), _length(vertices, second, apex)
    apex_x, apex_y = _lay_flat(length, from_first, from_second)
    down = apex_y + y
    across = x + (apex_x - x) * y / down if down > 0.0 else apex_x
    if low <= across <= high:
        _reach(apex, before + np.hypot(apex_x - x, down), bends, distances, heap)
    if low < across:  # on to the edge from apex to first: seen from its twin, first to apex
        _push(first, apex, second, 0.0, 0.0, apex_x, apex_y, length, low, min(high, across),
              from_first, twins[3 * f + (k + 2) % 3], x, y, before, distances, heap)  # fmt: skip
    if high > across:  # the edge from second to apex: its twin runs from apex to second
        _push(apex, second, first, apex_x, apex_y, length, 0.0, 0.0, max(low, across), high,
              from_second, twins[3 * f + (k + 1) % 3], x, y, before, distances, heap)  # fmt: skip


@njit(cache=True, nogil=True)
def _push(start, end, across, start_x, start_y, end_x, end_y, across_x, low, high,
          length, twin, x, y, before, distances, heap):  # fmt: skip
    """Put the part of an edge on the heap that is seen through [low, high], unless paths by corners are shorter.

    The edge runs from `start` to `end`, `across` at (across_x, 0) is the corner opposite.
    """
    if twin < 0:
        return
    along_x, along_y = (end_x - start_x) / length, (end_y - start_y) / length
    a = _meet(low, x, y, start_x, start_y, along_x, along_y, length)
    b = _meet(high, x, y, start_x, start_y, along_x, along_y, length)
    if a > b:
        a, b = b, a
    if b - a < 1e-12 * length:
        return
    ax, ay, bx, by = start_x + a * along_x, start_y + a * along_y, start_x + b * along_x, start_y + b * along_y
    to_a, to_b = before + np.hypot(ax - x, ay + y), before + np.hypot(bx - x, by + y)
    slack = 1e-12 * (to_a + to_b)
    if to_b > distances[start] + b + slack or to_a > distances[end] + length - a + slack:
        return
    if across_x > 0.0:  # `start` is on the edge that was crossed, and a nearer to it
        is_behind = to_a > distances[across] + np.hypot(ax - across_x, ay) + slack
    else:
        is_behind = to_b > distances[across] + np.hypot(bx - across_x, by) + slack
    if is_behind:
        return
    # the source in the frame of the edge: x along it, y away from the face to be entered
    flat_x = (x - start_x) * along_x + (-y - start_y) * along_y
    flat_y = abs((x - start_x) * along_y - (-y - start_y) * along_x)
    nearest = flat_y if a < flat_x < b else min(to_a, to_b) - before
    heapq.heappush(heap, (before + nearest, twin, a, b, flat_x, flat_y, before))


@njit(cache=True, nogil=True)
def _meet(through, x, y, start_x, start_y, along_x, along_y, length):
    """Where on an edge the line from (x, -y) by (through, 0) meets it, from 0 to its length."""
    ray_x, ray_y = through - x, y
    cross = ray_x * along_y - ray_y * along_x
    if abs(cross) < 1e-300:
        return 0.0
    return min(length, max(0.0, ((start_x - x) * ray_y - (start_y + y) * ray_x) / cross))

"""Vertices inside parts that they may not enter, and how deep they are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.geometry.exits import count_windings, find_distance, find_exits
from tracker.model.scene import PosedScene
from tracker.terms.colliding_parts import Crossings, find_crossings

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

TRIES = 3
"""A region is outside when this many of its vertices are."""


class Swallowed(NamedTuple):
    """Vertices inside another part.

    ids (N,) vertices; receivers (N,) the triangle through which each would leave against its own normal; distances
    (N, 2) to that triangle, and to where it would leave along its normal, m; cosines (N,) between the way back and the
    normal of the receiver.
    """

    ids: Ints
    receivers: Ints
    distances: Array
    cosines: Array


def find_swallowed(posed: PosedScene, crossings: Crossings, on_crossing_triangles: bool = False) -> Swallowed:
    """Vertices inside another model or a part that is no neighbour.

    Crossing triangles cut the mesh into regions, and no edge of a region enters or leaves anything: a few vertices
    (TRIES) say whether a region is inside at all. So a whole piece of surface inside another is found as well, and
    there is next to nothing to do where nothing crosses.

    Args:
        posed: The scene.
        crossings: Of the same posed scene.
        on_crossing_triangles: Whether vertices of crossing triangles are returned too.
    """
    count = len(posed.vertices)
    out = Swallowed(
        np.empty(count, dtype=np.int32), np.empty(count, dtype=np.int32), np.empty((count, 2)), np.empty(count)
    )
    found = _find_swallowed_into(
        out, crossings.pairs, crossings.parts, crossings.fitted, posed.normals, on_crossing_triangles
    )
    return Swallowed(out.ids[:found], out.receivers[:found], out.distances[:found], out.cosines[:found])


def measure_penetration(posed: PosedScene) -> float:
    """The deepest that any vertex is inside a part that it may not enter: its distance to the surface there, m.

    0 where nothing is inside. Recorded and annotated poses interpenetrate too: compare with them, not with zero.
    """
    crossings = find_crossings(posed)
    inside = find_swallowed(posed, crossings, on_crossing_triangles=True)
    return float(_measure(inside, crossings.parts, crossings.fitted))


@njit(cache=True, nogil=True)
def _find_swallowed_into(out, pairs, parts, fitted, normals, on_crossing_triangles):
    found, borders = 0, 0
    vertices, faces = fitted.vertices, fitted.faces
    is_seen = np.zeros(len(vertices), dtype=np.bool_)
    border = np.empty(len(vertices), dtype=np.int32)
    region = np.empty(len(vertices), dtype=np.int32)
    for pair in range(len(pairs)):
        for side in range(2):
            for corner in range(3):
                v = faces[pairs[pair, side], corner]
                if not is_seen[v]:
                    is_seen[v] = True
                    border[borders] = v
                    borders += 1
    if on_crossing_triangles:
        for place in range(borders):
            found += _look(out, found, parts, fitted, normals, border[place])
    for place in range(borders + len(parts.seeds)):
        if place < borders:
            begin, end = parts.neighbour_starts[border[place]], parts.neighbour_starts[border[place] + 1]
        else:
            begin, end = place - borders, place - borders + 1
        for at in range(begin, end):
            start = parts.neighbours[at] if place < borders else parts.seeds[at]
            if is_seen[start]:
                continue
            count = _spread(region, is_seen, start, parts.neighbour_starts, parts.neighbours)
            before = found
            for member in range(count):
                if member == TRIES and found == before:
                    break
                found += _look(out, found, parts, fitted, normals, region[member])
    return found


@njit(cache=True, nogil=True)
def _spread(region, is_seen, start, neighbour_starts, neighbours):
    """Write the vertices that are joined to `start` over unseen vertices, mark them, and return their number."""
    is_seen[start] = True
    region[0] = start
    count, done = 1, 0
    while done < count:
        v = region[done]
        done += 1
        for place in range(neighbour_starts[v], neighbour_starts[v + 1]):
            other = neighbours[place]
            if not is_seen[other]:
                is_seen[other] = True
                region[count] = other
                count += 1
    return count


@njit(cache=True, nogil=True)
def _look(out, found, parts, fitted, normals, v):
    """Write vertex v at place `found` if it is inside something; 1 if so, otherwise 0."""
    point, direction = fitted.vertices[v], normals[v]
    deepest = 0.0
    if direction[0] == 0.0 and direction[1] == 0.0 and direction[2] == 0.0:
        return 0
    may_meet, own = parts.vertices_may_meet[v], parts.vertex_groups[v]
    for model in range(len(parts.model_starts) - 1):
        start, stop = parts.model_starts[model], parts.model_starts[model + 1]
        if not _is_near(fitted, may_meet, start, stop, point):
            continue
        triangle, back, cosine, ahead = find_exits(fitted, may_meet, own, start, stop, point, direction)
        if triangle >= 0 and back >= deepest and count_windings(fitted, start, stop, point, direction, v) > 0:
            deepest = back
            out.ids[found], out.receivers[found], out.cosines[found] = v, triangle, cosine
            out.distances[found, 0], out.distances[found, 1] = back, ahead
    return 1 if deepest > 0.0 else 0


@njit(cache=True, nogil=True)
def _is_near(fitted, may_meet, start, stop, point):
    """Whether a point is in the box of any group that it may meet: the flesh of a body is in its limbs' boxes."""
    roots, boxes = fitted.tree.roots, fitted.node_boxes
    x, y, z = point[0], point[1], point[2]
    for group in range(start, stop):
        node = roots[group]
        if node >= 0 and may_meet[group]:
            low = (boxes[node, 0] <= x) & (boxes[node, 1] <= y) & (boxes[node, 2] <= z)
            if low & (boxes[node, 3] >= x) & (boxes[node, 4] >= y) & (boxes[node, 5] >= z):
                return True
    return False


@njit(cache=True, nogil=True)
def _measure(inside, parts, fitted):
    deepest = 0.0
    for place in range(len(inside.ids)):
        v = inside.ids[place]
        model = 0
        while parts.model_starts[model + 1] <= parts.tree.groups[inside.receivers[place]]:
            model += 1
        start, stop = parts.model_starts[model], parts.model_starts[model + 1]
        may_meet, own = parts.vertices_may_meet[v], parts.vertex_groups[v]
        deepest = max(deepest, find_distance(fitted, may_meet, own, start, stop, fitted.vertices[v]))
    return deepest

"""Closest points on a posed mesh among the triangles that look the same way.

The closest triangle is found exactly as if all were flat; the distance is that to the curved one (`curved_triangles`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.geometry.triangle_tree import Filter, build_triangle_tree, fit_tree
from tracker.geometry.triangles import find_closest
from tracker.registration.curved_triangles import find_bulges, find_height

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

MIN_COSINE = 0.25
"""Cosine between the normals of a point and of the triangle it may lie on."""


@dataclass(frozen=True)
class Matches:
    """Where points (N,) lie on a mesh.

    Attributes:
        faces: (N,) triangle, -1 where none is near enough and looks the same way.
        weights: (N, 3) of the triangle's corners.
        directions: (N, 3) unit, in which the distance is measured: the triangle's normal where the point lies over its
            inside, else from the closest point to the point. So the derivative of the distance from flat triangles is
            exact; how they bulge is held.
        offsets: (N,) signed distance from the curved triangle along that direction, m.
        heights: (N,) how far the curved triangle lies above the flat one there, m.
        on_rim: (N,) the closest point lies on the open rim of the mesh.
    """

    faces: Ints
    weights: Array
    directions: Array
    offsets: Array
    heights: Array
    on_rim: npt.NDArray[np.bool_]


class SurfaceSearch:
    """Finds closest points on one mesh in whatever pose; the tree is built once and refitted.

    Args:
        vertices: (V, 3) at rest, m.
        faces: (F, 3).
    """

    def __init__(self, vertices: Array, faces: npt.NDArray) -> None:
        self.faces = np.ascontiguousarray(faces, dtype=np.int32)
        groups = np.zeros(len(faces), dtype=np.int32)
        self._tree = build_triangle_tree(vertices[self.faces].mean(axis=1), groups, 1)
        self._filter = Filter(np.zeros((1, 1), dtype=np.bool_), np.zeros((0, 1), dtype=np.bool_))
        self.is_rim_edge, self.is_rim_vertex = _find_rim(self.faces, len(vertices))

    def match(
        self,
        vertices: Array,
        points: Array,
        normals: Array,
        reach: float,
        seeds: Ints | None = None,
    ) -> Matches:
        """Closest points on the mesh at `vertices`.

        Args:
            vertices: (V, 3) m.
            points: (N, 3) m.
            normals: (N, 3) unit; zero matches whatever way the triangle looks.
            reach: Largest distance that is looked for, m.
            seeds: (N,) triangles to begin with, such as those of the last pose.
        """
        fitted = fit_tree(self._tree, self._filter, vertices, self.faces)
        count = len(points)
        found = Matches(
            np.full(count, -1, dtype=np.int32) if seeds is None else seeds.copy(),
            np.zeros((count, 3)),
            np.zeros((count, 3)),
            np.zeros(count),
            np.zeros(count),
            np.zeros(count, dtype=np.bool_),
        )
        face_normals = np.empty((len(self.faces), 3))
        find_face_normals(face_normals, vertices, self.faces)
        tree = self._tree
        _match_into(
            (found.faces, found.weights, found.directions, found.offsets, found.heights, found.on_rim),
            (points, normals),
            (vertices, self.faces, face_normals, find_bulges(vertices, self.faces)),
            (fitted.node_boxes, tree.order, tree.starts, tree.ends, tree.skip),
            (self.is_rim_edge, self.is_rim_vertex),
            reach,
        )
        return found


def _find_rim(faces: Ints, num_vertices: int) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """(F, 3) whether the edge opposite to a corner has one face only, and (V,) whether a vertex has such an edge."""
    edges = np.stack([faces[:, [1, 2]], faces[:, [2, 0]], faces[:, [0, 1]]], axis=1).astype(np.int64)
    keys = edges.min(axis=2) * num_vertices + edges.max(axis=2)
    _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
    is_rim_edge = (counts == 1)[inverse].reshape(keys.shape)
    is_rim_vertex = np.zeros(num_vertices, dtype=np.bool_)
    is_rim_vertex[edges[is_rim_edge]] = True
    return is_rim_edge, is_rim_vertex


@njit(cache=True, nogil=True)
def find_face_normals(normals, vertices, faces):
    """Write the unit normals (F, 3); zero for a triangle without area."""
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1], vertices[b, 2] - vertices[a, 2]
        wx, wy, wz = vertices[c, 0] - vertices[a, 0], vertices[c, 1] - vertices[a, 1], vertices[c, 2] - vertices[a, 2]
        nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        length = np.sqrt(nx * nx + ny * ny + nz * nz)
        scale = 1.0 / length if length > 0.0 else 0.0
        normals[f, 0], normals[f, 1], normals[f, 2] = nx * scale, ny * scale, nz * scale


@njit(cache=True, nogil=True)
def _box_distance(boxes, n, x, y, z):
    dx = max(boxes[n, 0] - x, 0.0, x - boxes[n, 3])
    dy = max(boxes[n, 1] - y, 0.0, y - boxes[n, 4])
    dz = max(boxes[n, 2] - z, 0.0, z - boxes[n, 5])
    return dx * dx + dy * dy + dz * dz


@njit(cache=True, nogil=True)
def _match_into(matches, asked, mesh, tree, rim, reach):
    """Write the matches.

    Args:
        matches: Arrays of `Matches`, out; faces come with the triangles to begin with, or -1.
        asked: points (N, 3) and normals (N, 3).
        mesh: vertices (V, 3), faces (F, 3), face normals (F, 3) and bulges of `find_bulges`.
        tree: boxes, order, starts, ends and skip of a fitted triangle tree.
        rim: Edges (F, 3) and vertices (V,) on the rim.
        reach: m.
    """
    found, weights, directions, offsets, heights, on_rim = matches
    points, normals = asked
    vertices, faces, face_normals, bulges = mesh
    boxes, order, starts, ends, skip = tree
    rim_edges, rim_vertices = rim
    stack = np.empty(128, dtype=np.int32)
    near = np.empty(128)
    for p in range(len(points)):
        x, y, z = points[p, 0], points[p, 1], points[p, 2]
        mx, my, mz = normals[p, 0], normals[p, 1], normals[p, 2]
        is_free = mx == 0.0 and my == 0.0 and mz == 0.0
        best, face, share_b, share_c = reach * reach, -1, 0.0, 0.0
        seed = found[p]
        if seed >= 0:
            cosine = mx * face_normals[seed, 0] + my * face_normals[seed, 1] + mz * face_normals[seed, 2]
            if is_free or cosine > MIN_COSINE:
                square, s, t = find_closest(x, y, z, vertices, faces[seed, 0], faces[seed, 1], faces[seed, 2])
                if square < best:
                    best, face, share_b, share_c = square, seed, s, t
        top = 1
        stack[0], near[0] = 0, _box_distance(boxes, 0, x, y, z)
        while top > 0:
            top -= 1
            node = stack[top]
            if near[top] >= best:
                continue
            if skip[node] == node + 1:
                for place in range(starts[node], ends[node]):
                    f = order[place]
                    cosine = mx * face_normals[f, 0] + my * face_normals[f, 1] + mz * face_normals[f, 2]
                    if is_free or cosine > MIN_COSINE:
                        square, s, t = find_closest(x, y, z, vertices, faces[f, 0], faces[f, 1], faces[f, 2])
                        if square < best:
                            best, face, share_b, share_c = square, f, s, t
            else:
                first, second = node + 1, skip[node + 1]
                d1, d2 = _box_distance(boxes, first, x, y, z), _box_distance(boxes, second, x, y, z)
                if d1 < d2:
                    first, second, d1, d2 = second, first, d2, d1
                stack[top], near[top] = first, d1
                stack[top + 1], near[top + 1] = second, d2
                top += 2
        found[p] = face
        on_rim[p] = False
        if face < 0:
            continue
        share_a = 1.0 - share_b - share_c
        if share_a < 1e-12:
            share_a = 0.0
        weights[p, 0], weights[p, 1], weights[p, 2] = share_a, share_b, share_c
        is_inside = True
        for k in range(3):
            if weights[p, k] == 0.0:
                is_inside = False
                if rim_edges[face, k]:
                    on_rim[p] = True
            elif weights[p, k] == 1.0 and rim_vertices[faces[face, k]]:
                on_rim[p] = True
        nx, ny, nz = face_normals[face, 0], face_normals[face, 1], face_normals[face, 2]
        dx, dy, dz = x, y, z
        for k in range(3):
            v = faces[face, k]
            dx -= weights[p, k] * vertices[v, 0]
            dy -= weights[p, k] * vertices[v, 1]
            dz -= weights[p, k] * vertices[v, 2]
        length = np.sqrt(dx * dx + dy * dy + dz * dz)
        along = dx * nx + dy * ny + dz * nz
        if is_inside or length < 1e-7:
            directions[p, 0], directions[p, 1], directions[p, 2] = nx, ny, nz
            offsets[p] = along
        else:
            sign = 1.0 if along >= 0.0 else -1.0
            scale = sign / length
            directions[p, 0], directions[p, 1], directions[p, 2] = dx * scale, dy * scale, dz * scale
            offsets[p] = sign * length
        heights[p] = find_height(bulges, face, weights, p, directions)
        offsets[p] -= heights[p]

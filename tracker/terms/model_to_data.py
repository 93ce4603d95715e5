"""Fit the model to the data, [T16] §3.2.2, Eq. 6 and 7."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.terms.look import TermLook
from tracker.terms.nearby_pixels import find_ring_pixel, find_vertex_pixel
from tracker.terms.point_plane import PointToPlane
from tracker.terms.point_point import PointToPoint
from tracker.terms.residual import FrameContext
from tracker.terms.surface_rows import span


@dataclass(frozen=True)
class ModelToData:
    """Pull each visible vertex to the nearest point of the cloud: E = Σ |n_iᵀ(v_i − X_i)|², [T16] Eq. 7 (or Eq. 6).

    Matches farther than `max_distance` or with normals more than `max_angle` apart are left out. The nearest point is
    looked for in rings of pixels around the vertex's own, ending when no farther ring can hold a nearer point.

    Differs from the paper: the normal n_i(θ) is held fixed at its value when the match was made, as is usual.
    """

    look: ClassVar[TermLook] = TermLook("model_to_data", "Model to data", "#00b4e1", "#1e96a5")

    weight: float = 1.0
    """Eq. 5 gives this term weight one."""

    max_distance: float = 0.010
    """m (10 mm, §3.2.2)."""

    max_angle: float = 45.0
    """deg (§3.2.2)."""

    to_plane: bool = True
    """Point-to-plane (Eq. 7) or point-to-point (Eq. 6)."""

    stride: int = 1
    """One vertex in this many is matched."""

    visible_within: float = 0.003
    """A vertex is visible when it is at most this far behind the rendered surface, m."""

    def coarse(self) -> ModelToData:
        """The same term with fewer matches."""
        return replace(self, stride=4 * self.stride)

    def find(self, posed: PosedScene, context: FrameContext) -> PointToPlane | PointToPoint:
        """Match visible vertices to the cloud."""
        ids = np.empty(len(posed.vertices), dtype=np.int32)
        targets = np.empty((len(posed.vertices), 3))
        cosine = np.cos(np.deg2rad(self.max_angle))
        count = _find_into(ids, targets, context.drawn, self.stride, self.max_distance, cosine, self.visible_within)
        ids, targets = ids[:count], targets[:count]
        if self.to_plane:
            return PointToPlane(*span(ids), targets, posed.normals[ids], np.full(count, self.weight))
        return PointToPoint.of_vertices(ids, targets, self.weight)


@njit(cache=True, nogil=True)
def _find_into(ids, targets, drawn, stride, max_distance, min_cosine, visible_within):
    vertices, vertex_normals, projected, points, normals, labels = (
        drawn.vertices,
        drawn.vertex_normals,
        drawn.projected,
        drawn.points,
        drawn.normals,
        drawn.labels,
    )
    height, width = labels.shape
    count = 0
    for v in range(0, len(vertices), stride):
        row, column = find_vertex_pixel(projected, v, height, width)
        if row < 0:
            continue
        inverse, at = projected[v, 2], drawn.inverse_depth[row, column]
        if at > 0.0 and 1.0 / inverse > 1.0 / at + visible_within:
            continue
        nx, ny, nz = vertex_normals[v, 0], vertex_normals[v, 1], vertex_normals[v, 2]
        if nx == 0.0 and ny == 0.0 and nz == 0.0:
            continue
        x, y, z = vertices[v, 0], vertices[v, 1], vertices[v, 2]
        wanted = drawn.vertex_labels[v]
        pixel = 1.0 / (inverse * drawn.K[0, 0])  # width of a pixel at the vertex's depth, m
        best = max_distance * max_distance
        best_row, best_column = -1, -1
        ring = 0
        while True:
            nearest_possible = (ring - 0.5) * pixel
            if ring > 0 and nearest_possible * nearest_possible >= best:
                break
            for side in range(2 * ring + 1 if ring > 0 else 1):
                for edge in range(4 if ring > 0 else 1):
                    r, c = find_ring_pixel(row, column, ring, side, edge)
                    if r < 0 or c < 0 or r >= height or c >= width or labels[r, c] & wanted == 0:
                        continue
                    dx, dy, dz = points[r, c, 0] - x, points[r, c, 1] - y, points[r, c, 2] - z
                    distance = dx * dx + dy * dy + dz * dz
                    if distance < best:
                        cosine = normals[r, c, 0] * nx + normals[r, c, 1] * ny + normals[r, c, 2] * nz
                        if cosine >= min_cosine:
                            best = distance
                            best_row, best_column = r, c
            ring += 1
        if best_row >= 0:
            ids[count] = v
            for i in range(3):
                targets[count, i] = points[best_row, best_column, i]
            count += 1
    return count

"""Explain every data point by the drawn surface: the dense form of data-to-model, [T16] §3.2.3."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.terms.drawn_frame import Matches
from tracker.terms.look import TermLook
from tracker.terms.nearby_pixels import find_ring_pixel
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import barycentric_into


@dataclass(frozen=True)
class DataToSurface:
    """Pull the drawn surface onto the data points, every `stride`-th pixel: E = Σ |n_iᵀ(v_i − X_i)|², n_i of the face.

    Differs from the paper: T16 matches depth discontinuities only, because matching the whole cloud by a kd-tree cost
    40 % without lowering its error. Against the rendering the search is a few pixels, and on rendered twins the dense
    form is what keeps fingers apart (docs/journal.md). Normals of the face, held fixed: those of the data are noisy,
    and noisy normals hold a surface back along itself, like friction.
    """

    look: ClassVar[TermLook] = TermLook("data_to_surface", "Data to surface", "#a5ff69", "#699678", (10, 3))

    weight: float = 1.0
    stride: int = 3
    """px."""

    max_distance: float = 0.010
    """m."""

    max_angle: float = 60.0
    """Between the normals of data and face, deg."""

    def coarse(self) -> DataToSurface:
        """The same term with fewer matches."""
        return replace(self, stride=2 * self.stride)

    def find(self, posed: PosedScene, context: FrameContext) -> PointToPlane:
        """Match data pixels to the drawn surface."""
        height, width = context.observation.labels.shape
        matches = Matches.room((height // self.stride + 1) * (width // self.stride + 1))
        count = _find_into(matches, context.drawn, self.stride, self.max_distance, np.cos(np.deg2rad(self.max_angle)))
        ids, barycentric, targets, normals = matches.first(count)
        return PointToPlane(ids, barycentric, targets, normals, np.full(count, self.weight))


@njit(cache=True, nogil=True)
def _find_into(matches, drawn, stride, max_distance, min_cosine):
    ids, barycentric, targets, target_normals = matches
    face, face_labels, face_normals, inverse_depth, labels, normals = (
        drawn.face,
        drawn.face_labels,
        drawn.face_normals,
        drawn.inverse_depth,
        drawn.labels,
        drawn.normals,
    )
    height, width = labels.shape
    fx, fy, cx, cy = drawn.K[0, 0], drawn.K[1, 1], drawn.K[0, 2], drawn.K[1, 2]
    count = 0
    for row in range(stride // 2, height, stride):
        for column in range(stride // 2, width, stride):
            label = labels[row, column]
            if label == 0:
                continue
            nx, ny, nz = normals[row, column, 0], normals[row, column, 1], normals[row, column, 2]
            if nx == 0.0 and ny == 0.0 and nz == 0.0:
                continue
            z = drawn.depth[row, column]
            x, y = (column - cx) / fx * z, (row - cy) / fy * z
            pixel = z / fx
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
                        if r < 0 or c < 0 or r >= height or c >= width:
                            continue
                        f = face[r, c]
                        if f < 0 or label & face_labels[f] == 0:
                            continue
                        at = 1.0 / inverse_depth[r, c]
                        dz = at - z
                        if dz * dz >= best:
                            continue
                        dx, dy = (c - cx) / fx * at - x, (r - cy) / fy * at - y
                        distance = dx * dx + dy * dy + dz * dz
                        if distance < best:
                            n = face_normals[f]
                            if n[0] * nx + n[1] * ny + n[2] * nz >= min_cosine:
                                best = distance
                                best_row, best_column = r, c
                ring += 1
            if best_row >= 0:
                matched = face[best_row, best_column]
                corners = drawn.faces[matched]
                barycentric_into(barycentric[count], corners, drawn.projected, best_column, best_row)
                for i in range(3):
                    ids[count, i] = corners[i]
                    targets[count, i] = drawn.points[row, column, i]
                    target_normals[count, i] = face_normals[matched, i]
                count += 1
    return count

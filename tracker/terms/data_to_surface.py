"""Explain every data point by the drawn surface: the dense form of data-to-model, [T16] §3.2.3."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import barycentric_into


@dataclass(frozen=True)
class DataToSurface:
    """Pull the drawn surface onto the data points, every `stride`-th pixel: E = Σ |n_iᵀ(v_i − X_i)|², n_i of the face.

    Differs from the paper: T16 matches depth discontinuities only, because matching the whole cloud by a kd-tree cost
    40 % without lowering its error. Against the rendering the search is a few pixels, and on rendered twins the dense
    form is what keeps fingers apart (docs/objective.md). Normals of the face, held fixed: those of the data are noisy,
    and noisy normals hold a surface back along itself, like friction.
    """

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
        view, observation = context.view, context.observation
        height, width = observation.labels.shape
        room = ((height + self.stride - 1) // self.stride) * ((width + self.stride - 1) // self.stride)
        ids = np.empty((room, 3), dtype=np.int32)
        barycentric = np.empty((room, 3))
        targets = np.empty((room, 3))
        normals = np.empty((room, 3))
        count = _find_into(
            ids,
            barycentric,
            targets,
            normals,
            self.stride,
            posed.scene.arrays.faces,
            context.face_labels,
            view.face_normals,
            view.projected,
            view.inverse_depth,
            view.face,
            observation.points,
            observation.normals,
            observation.depth,
            observation.labels,
            view.K,
            self.max_distance,
            np.cos(np.deg2rad(self.max_angle)),
        )
        weights = np.full(count, self.weight)
        return PointToPlane(ids[:count], barycentric[:count], targets[:count], normals[:count], weights)


@njit(cache=True, nogil=True)
def _find_into(
    ids,
    barycentric,
    targets,
    target_normals,
    stride,
    faces,
    face_labels,
    face_normals,
    projected,
    inverse_depth,
    face,
    points,
    normals,
    depth,
    labels,
    K,
    max_distance,
    min_cosine,
):
    height, width = labels.shape
    fx, fy, cx, cy = K[0, 0], K[1, 1], K[0, 2], K[1, 2]
    count = 0
    for row in range(stride // 2, height, stride):
        for column in range(stride // 2, width, stride):
            label = labels[row, column]
            if label == 0:
                continue
            nx, ny, nz = normals[row, column, 0], normals[row, column, 1], normals[row, column, 2]
            if nx == 0.0 and ny == 0.0 and nz == 0.0:
                continue
            z = depth[row, column]
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
                        if edge == 0:
                            r, c = row - ring, column - ring + side
                        elif edge == 1:
                            r, c = row + ring, column - ring + side
                        elif edge == 2:
                            r, c = row - ring + side, column - ring
                        else:
                            r, c = row - ring + side, column + ring
                        if r < 0 or c < 0 or r >= height or c >= width:
                            continue
                        f = face[r, c]
                        if f < 0 or label & face_labels[f] == 0:
                            continue
                        drawn = 1.0 / inverse_depth[r, c]
                        dz = drawn - z
                        if dz * dz >= best:
                            continue
                        dx, dy = (c - cx) / fx * drawn - x, (r - cy) / fy * drawn - y
                        distance = dx * dx + dy * dy + dz * dz
                        if distance < best:
                            n = face_normals[f]
                            if n[0] * nx + n[1] * ny + n[2] * nz >= min_cosine:
                                best = distance
                                best_row, best_column = r, c
                ring += 1
            if best_row >= 0:
                matched = face[best_row, best_column]
                corners = faces[matched]
                barycentric_into(barycentric[count], corners, projected, best_column, best_row)
                for i in range(3):
                    ids[count, i] = corners[i]
                    targets[count, i] = points[row, column, i]
                    target_normals[count, i] = face_normals[matched, i]
                count += 1
    return count

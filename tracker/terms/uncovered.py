"""Cover what was seen by the drawn model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.terms.nearby_pixels import find_nearby_pixels
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import barycentric_into


@dataclass(frozen=True)
class Uncovered:
    """Pull the model over data that it leaves uncovered, E = Σ |uᵀ(v − X)|²: the silhouette seen from the other side.

    A data pixel without drawn surface at its depth pulls the nearest drawn pixel, at most `max_pixels` away, across the
    viewing rays. Where no surface is drawn that near, it pulls the nearest vertex in space, hidden ones too, straight
    to the data point: a thumb that comes out from behind the other hand, the end of a rope that curled up.

    Palms are not pulled: what lies beyond them is the forearm, which no model has.

    Differs from the paper: not in it. A point-to-plane match holds a surface along its normal only, so nothing else
    tells how far a finger or a rope reaches.
    """

    weight: float = 0.05
    stride: int = 2
    """px."""

    max_pixels: int = 8
    """To the nearest drawn pixel, px."""

    within: float = 0.015
    """Data and drawn surface within this in depth cover one another, m."""

    far_stride: int = 6
    """Of pixels that no surface is drawn near to, px."""

    max_distance: float = 0.040
    """To the nearest vertex in space, m."""

    def coarse(self) -> Uncovered:
        """The same term with fewer matches."""
        return replace(self, stride=2 * self.stride)

    def find(self, posed: PosedScene, context: FrameContext) -> PointToPlane:
        """Look for data pixels that nothing covers."""
        view, observation = context.view, context.observation
        faces, labels = posed.scene.arrays.faces, observation.labels
        is_palm = posed.scene.is_palm
        room = (labels.shape[0] // self.stride + 1) * (labels.shape[1] // self.stride + 1)
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
            faces,
            context.face_labels,
            context.vertex_labels[: posed.scene.landmark_slices[0].start],
            is_palm,
            posed.vertices,
            view.projected,
            view.inverse_depth,
            view.face,
            observation.points,
            observation.depth,
            labels,
            view.K,
            observation.T_world_camera,
            find_nearby_pixels(self.max_pixels),
            self.within,
            self.far_stride,
            self.max_distance,
        )
        weights = np.full(count, self.weight)
        return PointToPlane(ids[:count], barycentric[:count], targets[:count], normals[:count], weights)


@njit(cache=True, nogil=True)
def _find_into(
    ids,
    barycentric,
    targets,
    normals,
    stride,
    faces,
    face_labels,
    vertex_labels,
    is_palm,
    vertices,
    projected,
    inverse_depth,
    face,
    points,
    depth,
    labels,
    K,
    T,
    nearby,
    within,
    far_stride,
    max_distance,
):
    height, width = labels.shape
    fx, fy, cx, cy = K[0, 0], K[1, 1], K[0, 2], K[1, 2]
    wanted = 0
    for f in range(len(face_labels)):
        wanted |= face_labels[f]
    count = 0
    for row in range(stride // 2, height, stride):
        for column in range(stride // 2, width, stride):
            label = labels[row, column]
            if label & wanted == 0 or _covers(
                face, face_labels, inverse_depth, row, column, label, depth[row, column], within
            ):
                continue
            z = depth[row, column]
            to_row, to_column = -1, -1
            for step in range(1, len(nearby)):
                r, c = row + nearby[step, 0], column + nearby[step, 1]
                if r < 0 or c < 0 or r >= height or c >= width:
                    continue
                if _covers(face, face_labels, inverse_depth, r, c, label, z, within):
                    to_row, to_column = r, c
                    break
            if to_row >= 0:
                corners = faces[face[to_row, to_column]]
                if is_palm[corners[0]] or is_palm[corners[1]] or is_palm[corners[2]]:
                    continue
                # Across the viewing ray, so that depth stays as it is.
                drawn = 1.0 / inverse_depth[to_row, to_column]
                dx, dy = (column - to_column) / fx * drawn, (row - to_row) / fy * drawn
                rx, ry = (to_column - cx) / fx, (to_row - cy) / fy
                along = (dx * rx + dy * ry) / (rx * rx + ry * ry + 1.0)
                ux, uy, uz = dx - along * rx, dy - along * ry, -along
                length = np.sqrt(ux * ux + uy * uy + uz * uz)
                barycentric_into(barycentric[count], corners, projected, to_column, to_row)
                for i in range(3):
                    ids[count, i] = corners[i]
                    normals[count, i] = (T[i, 0] * ux + T[i, 1] * uy + T[i, 2] * uz) / length
                    point = 0.0
                    for corner in range(3):
                        point += barycentric[count, corner] * vertices[corners[corner], i]
                    targets[count, i] = point + length * normals[count, i]
                count += 1
            elif row % far_stride == stride // 2 and column % far_stride == stride // 2:
                point = points[row, column]
                nearest, distance = -1, max_distance * max_distance
                for v in range(len(vertex_labels)):
                    if vertex_labels[v] & label == 0:
                        continue
                    x, y, w = vertices[v, 0] - point[0], vertices[v, 1] - point[1], vertices[v, 2] - point[2]
                    squared = x * x + y * y + w * w
                    if squared < distance:
                        nearest, distance = v, squared
                if nearest < 0 or is_palm[nearest] or distance == 0.0:
                    continue
                distance = np.sqrt(distance)
                for i in range(3):
                    ids[count, i] = nearest
                    barycentric[count, i] = 1.0 if i == 0 else 0.0
                    targets[count, i] = point[i]
                    normals[count, i] = (point[i] - vertices[nearest, i]) / distance
                count += 1
    return count


@njit(cache=True, nogil=True)
def _covers(face, face_labels, inverse_depth, row, column, label, z, within):
    """Whether the surface drawn at a pixel may be what was seen with a label at depth z."""
    f = face[row, column]
    return f >= 0 and face_labels[f] & label != 0 and abs(1.0 / inverse_depth[row, column] - z) < within

"""Cover what was seen by the drawn model."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.terms.drawn_frame import Matches
from tracker.terms.look import TermLook
from tracker.terms.nearby_pixels import find_nearby_pixels
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import barycentric_into

BLOCK = 4
"""Side of the blocks in which the search first asks whether anything is drawn near, px."""


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

    look: ClassVar[TermLook] = TermLook("uncovered", "Uncovered", "#3c962d", "#b4693c", (8, 4))

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
        height, width = context.observation.labels.shape
        matches = Matches.room((height // self.stride + 1) * (width // self.stride + 1))
        nearby = find_nearby_pixels(self.max_pixels)
        count = _find_into(matches, context.drawn, self.stride, nearby, self.within, self.far_stride, self.max_distance)
        ids, barycentric, targets, normals = matches.first(count)
        return PointToPlane(ids, barycentric, targets, normals, np.full(count, self.weight))


@njit(cache=True, nogil=True)
def _find_into(matches, drawn, stride, nearby, within, far_stride, max_distance):
    ids, barycentric, targets, normals = matches
    face, face_labels, inverse_depth, labels, vertices, is_palm, T = (
        drawn.face,
        drawn.face_labels,
        drawn.inverse_depth,
        drawn.labels,
        drawn.vertices,
        drawn.is_palm,
        drawn.T,
    )
    height, width = labels.shape
    fx, fy, cx, cy = drawn.K[0, 0], drawn.K[1, 1], drawn.K[0, 2], drawn.K[1, 2]
    wanted = 0
    for f in range(len(face_labels)):
        wanted |= face_labels[f]
    is_near_drawn = _find_blocks_near_drawn(face, np.abs(nearby).max())
    count = 0
    for row in range(stride // 2, height, stride):
        for column in range(stride // 2, width, stride):
            label = labels[row, column]
            z = drawn.depth[row, column]
            if label & wanted == 0 or _covers(face, face_labels, inverse_depth, row, column, label, z, within):
                continue
            to_row, to_column = -1, -1
            for step in range(1, len(nearby) if is_near_drawn[row // BLOCK, column // BLOCK] else 1):
                r, c = row + nearby[step, 0], column + nearby[step, 1]
                if r < 0 or c < 0 or r >= height or c >= width:
                    continue
                if _covers(face, face_labels, inverse_depth, r, c, label, z, within):
                    to_row, to_column = r, c
                    break
            if to_row >= 0:
                corners = drawn.faces[face[to_row, to_column]]
                if is_palm[corners[0]] or is_palm[corners[1]] or is_palm[corners[2]]:
                    continue
                # Across the viewing ray, so that depth stays as it is.
                at = 1.0 / inverse_depth[to_row, to_column]
                dx, dy = (column - to_column) / fx * at, (row - to_row) / fy * at
                rx, ry = (to_column - cx) / fx, (to_row - cy) / fy
                along = (dx * rx + dy * ry) / (rx * rx + ry * ry + 1.0)
                ux, uy, uz = dx - along * rx, dy - along * ry, -along
                length = np.sqrt(ux * ux + uy * uy + uz * uz)
                barycentric_into(barycentric[count], corners, drawn.projected, to_column, to_row)
                for i in range(3):
                    ids[count, i] = corners[i]
                    normals[count, i] = (T[i, 0] * ux + T[i, 1] * uy + T[i, 2] * uz) / length
                    point = 0.0
                    for corner in range(3):
                        point += barycentric[count, corner] * vertices[corners[corner], i]
                    targets[count, i] = point + length * normals[count, i]
                count += 1
            elif row % far_stride == stride // 2 and column % far_stride == stride // 2:
                point = drawn.points[row, column]
                nearest, distance = -1, max_distance * max_distance
                px, py, pz = np.float64(point[0]), np.float64(point[1]), np.float64(point[2])
                for v in range(len(is_palm)):
                    x, y, w = vertices[v, 0] - px, vertices[v, 1] - py, vertices[v, 2] - pz
                    squared = x * x + y * y + w * w
                    if squared < distance and drawn.vertex_labels[v] & label != 0:
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
def _find_blocks_near_drawn(face, radius):
    """Whether anything can be drawn within `radius` px of each block: most of a forearm has nothing to look for."""
    rows, columns = (face.shape[0] - 1) // BLOCK + 1, (face.shape[1] - 1) // BLOCK + 1
    reach = (radius - 1) // BLOCK + 1
    near = np.zeros((rows, columns), dtype=np.uint8)
    for row in range(rows):
        for column in range(columns):
            if _is_drawn(face, row * BLOCK, column * BLOCK):
                for r in range(max(0, row - reach), min(rows, row + reach + 1)):
                    for c in range(max(0, column - reach), min(columns, column + reach + 1)):
                        near[r, c] = 1
    return near


@njit(cache=True, nogil=True)
def _is_drawn(face, row, column):
    """Whether anything is drawn in the block that begins there."""
    for r in range(row, min(face.shape[0], row + BLOCK)):
        for c in range(column, min(face.shape[1], column + BLOCK)):
            if face[r, c] >= 0:
                return True
    return False


@njit(cache=True, nogil=True)
def _covers(face, face_labels, inverse_depth, row, column, label, z, within):
    """Whether the surface drawn at a pixel may be what was seen with a label at depth z."""
    f = face[row, column]
    return f >= 0 and face_labels[f] & label != 0 and abs(1.0 / inverse_depth[row, column] - z) < within

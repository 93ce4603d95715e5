"""Fit the data to the model at depth discontinuities, [T16] §3.2.3, Eq. 8."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.observation.depth_edges import find_fall
from tracker.observation.observation import HAND
from tracker.terms.drawn_frame import Matches
from tracker.terms.look import TermLook
from tracker.terms.nearby_pixels import find_nearby_pixels, find_vertex_pixel
from tracker.terms.point_line import PointToLine
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import barycentric_into

NOWHERE = np.zeros((0, 0), dtype=np.int32)

VISIBLE_WITHIN = 0.003
"""A vertex is visible when it is at most this far behind the drawn surface, m."""


@dataclass(frozen=True)
class DataToModel:
    """Pull depth discontinuities of the model towards those of the image: E = Σ |v_i(θ) × d_i − m_i|², [T16] Eq. 8.

    A drawn pixel next to nothing or to something deeper is a discontinuity of the model. It is matched to the nearest
    discontinuity of the image at which the surface ends to the same side: the left contour of a finger never meets the
    right contour of its neighbour. The error is the distance of the surface point from that pixel's viewing ray, so the
    unreliable depth at an edge only rejects outliers: it is averaged over 3x3 pixels.

    Differs from the paper: a smaller weight and a limit in pixels. On rendered twins full weight within 20 px drew
    fingers to their neighbour's contour (docs/journal.md).
    """

    look: ClassVar[TermLook] = TermLook("data_to_model", "Data to model", "#e13cb4", "#780f69", (6, 3))

    weight: float = 0.2
    max_distance: float = 0.030
    """m (30 mm, §3.2.3)."""

    max_pixels: int = 8
    """px."""

    max_angle: float = 45.0
    """deg between the directions in which the two end (§3.3: as for RGB, "the orientation of the edges is taken into
    account for matching"; the angle is that of §3.2.2); 180 matches whatever is nearest."""

    at_vertices: bool = False
    """Whether only vertices at discontinuities are matched, as Eq. 8 has them, or every pixel of one: meshes are much
    coarser than pixels."""

    stride: int = 2
    """One discontinuity in this many is matched: they lie pixel by pixel along a contour."""

    jump: float = 0.015
    """Depth step of a discontinuity, m."""

    def coarse(self) -> DataToModel:
        """The same term with fewer matches."""
        return replace(self, stride=2 * self.stride)

    def find(self, posed: PosedScene, context: FrameContext) -> PointToLine:
        """Match discontinuities of the drawn model to those of the image."""
        view = context.view
        matches = Matches.room(max(1, int(np.count_nonzero(view.face >= 0))))
        vertex_at = _find_vertex_pixels(view.projected, view.inverse_depth) if self.at_vertices else NOWHERE
        nearby, cosine = find_nearby_pixels(self.max_pixels), np.cos(np.deg2rad(self.max_angle))
        count = _find_into(matches, context.drawn, vertex_at, self.stride, self.jump, nearby, self.max_distance, cosine)
        ids, barycentric, moments, directions = matches.first(count)
        return PointToLine(ids, barycentric, directions, moments, np.full(count, self.weight))


@njit(cache=True, nogil=True)
def _find_into(matches, drawn, vertex_at, stride, jump, nearby, max_distance, min_cosine):
    ids, barycentric, moments, directions = matches
    face, face_labels, inverse_depth, depth, labels, edges, T = (
        drawn.face,
        drawn.face_labels,
        drawn.inverse_depth,
        drawn.depth,
        drawn.labels,
        drawn.edges,
        drawn.T,
    )
    height, width = labels.shape
    fx, fy, cx, cy = drawn.K[0, 0], drawn.K[1, 1], drawn.K[0, 2], drawn.K[1, 2]
    count = 0
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            f = face[row, column]
            if f < 0 or (row + column) % stride != 0 or (len(vertex_at) > 0 and vertex_at[row, column] < 0):
                continue
            z = 1.0 / inverse_depth[row, column]
            farthest = 1.0 / (z + jump)
            if (
                inverse_depth[row - 1, column] >= farthest
                and inverse_depth[row + 1, column] >= farthest
                and inverse_depth[row, column - 1] >= farthest
                and inverse_depth[row, column + 1] >= farthest
            ):
                continue
            kind = 0 if face_labels[f] & HAND != 0 else 1
            x, y = find_fall(inverse_depth, True, row, column, jump)
            to_row, to_column = -1, -1
            for step in range(len(nearby)):
                r, c = row + nearby[step, 0], column + nearby[step, 1]
                if r >= 0 and c >= 0 and r < height and c < width and edges[kind, r, c]:
                    to_x, to_y = find_fall(depth, False, r, c, jump)
                    if x * to_x + y * to_y >= min_cosine:
                        to_row, to_column = r, c
                        break
            if to_row < 0 or labels[to_row, to_column] & face_labels[f] == 0:
                continue
            total, seen = 0.0, 0
            for r in range(max(0, to_row - 1), min(height, to_row + 2)):
                for c in range(max(0, to_column - 1), min(width, to_column + 2)):
                    if depth[r, c] > 0.0:
                        total += depth[r, c]
                        seen += 1
            mean = total / seen
            rx, ry = (to_column - cx) / fx, (to_row - cy) / fy
            ex, ey = rx * mean - (column - cx) / fx * z, ry * mean - (row - cy) / fy * z
            if ex * ex + ey * ey + (mean - z) ** 2 > max_distance * max_distance:
                continue
            length = np.sqrt(rx * rx + ry * ry + 1.0)
            corners = drawn.faces[f]
            if len(vertex_at) > 0:
                barycentric[count, 0], barycentric[count, 1], barycentric[count, 2] = 1.0, 0.0, 0.0
            else:
                barycentric_into(barycentric[count], corners, drawn.projected, column, row)
            d = directions[count]
            for i in range(3):
                ids[count, i] = corners[i] if len(vertex_at) == 0 else vertex_at[row, column]
                d[i] = (T[i, 0] * rx + T[i, 1] * ry + T[i, 2]) / length
            moments[count, 0] = T[1, 3] * d[2] - T[2, 3] * d[1]
            moments[count, 1] = T[2, 3] * d[0] - T[0, 3] * d[2]
            moments[count, 2] = T[0, 3] * d[1] - T[1, 3] * d[0]
            count += 1
    return count


@njit(cache=True, nogil=True)
def _find_vertex_pixels(projected, inverse_depth):
    """(H, W) the nearest visible vertex that projects into each pixel, -1 for none."""
    height, width = inverse_depth.shape
    vertex_at = np.full((height, width), -1, dtype=np.int32)
    for v in range(len(projected)):
        row, column = find_vertex_pixel(projected, v, height, width)
        if row < 0:
            continue
        inverse, drawn = projected[v, 2], inverse_depth[row, column]
        if drawn <= 0.0 or 1.0 / inverse > 1.0 / drawn + VISIBLE_WITHIN:
            continue
        if vertex_at[row, column] < 0 or inverse > projected[vertex_at[row, column], 2]:
            vertex_at[row, column] = v
    return vertex_at

"""Keep the drawn model inside what was seen."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numba import njit

from tracker.model.scene import PosedScene
from tracker.observation.observation import HAND
from tracker.terms.drawn_frame import Matches
from tracker.terms.look import TermLook
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import barycentric_into


@dataclass(frozen=True)
class Silhouette:
    """Push surface that is drawn where the sensor looked through it towards the nearest hand pixel.

    A pixel of the model without data is moved in the image plane by the distance d to the nearest hand pixel, which is
    d z / f in space. Surface behind something nearer is hidden, not wrong, and is left alone.

    Differs from the paper: not in it; T16's depth discontinuities (`DataToModel`) hold the silhouette there.
    """

    look: ClassVar[TermLook] = TermLook("silhouette", "Silhouette", "#e1c30f", "#968700", (2, 3))

    weight: float = 0.3
    stride: int = 2
    """px."""

    hidden_within: float = 0.010
    """Another surface at most this far behind the model still hides it, m."""

    max_distance: float = 0.040
    """A farther hand pixel pulls no harder than this, m."""

    def coarse(self) -> Silhouette:
        """The same term with fewer matches."""
        return replace(self, stride=2 * self.stride)

    def find(self, posed: PosedScene, context: FrameContext) -> PointToPlane:
        """Look for drawn pixels in free space."""
        height, width = context.observation.labels.shape
        matches = Matches.room((height // self.stride + 1) * (width // self.stride + 1))
        count = _find_into(matches, context.drawn, self.stride, self.hidden_within, self.max_distance)
        ids, barycentric, targets, normals = matches.first(count)
        return PointToPlane(ids, barycentric, targets, normals, np.full(count, self.weight))


@njit(cache=True, nogil=True)
def _find_into(matches, drawn, stride, hidden_within, max_distance):
    ids, barycentric, targets, normals = matches
    face, face_labels, labels, depth, T = drawn.face, drawn.face_labels, drawn.labels, drawn.depth, drawn.T
    height, width = labels.shape
    fx, fy, cx, cy = drawn.K[0, 0], drawn.K[1, 1], drawn.K[0, 2], drawn.K[1, 2]
    count = 0
    for row in range(stride // 2, height, stride):
        for column in range(stride // 2, width, stride):
            f = face[row, column]
            if f < 0 or labels[row, column] & face_labels[f] != 0:
                continue
            z = 1.0 / drawn.inverse_depth[row, column]
            if labels[row, column] != 0 and depth[row, column] < z + hidden_within:
                continue
            kind = 0 if face_labels[f] & HAND != 0 else 1
            to_row, to_column = drawn.nearest[kind, row, column, 0], drawn.nearest[kind, row, column, 1]
            if to_row < 0 or (to_row == row and to_column == column):
                continue
            dx, dy = (to_column - column) / fx * z, (to_row - row) / fy * z
            length = np.sqrt(dx * dx + dy * dy)
            pull = min(length, max_distance)
            dx, dy = dx / length, dy / length
            # Across the viewing ray, so that depth stays as it is.
            rx, ry = (column - cx) / fx, (row - cy) / fy
            along = (dx * rx + dy * ry) / (rx * rx + ry * ry + 1.0)
            ux, uy, uz = dx - along * rx, dy - along * ry, -along
            scale = 1.0 / np.sqrt(ux * ux + uy * uy + uz * uz)
            corners = drawn.faces[f]
            barycentric_into(barycentric[count], corners, drawn.projected, column, row)
            for i in range(3):
                ids[count, i] = corners[i]
                normal = (T[i, 0] * ux + T[i, 1] * uy + T[i, 2] * uz) * scale
                point = 0.0
                for corner in range(3):
                    point += barycentric[count, corner] * drawn.vertices[corners[corner], i]
                normals[count, i] = normal
                targets[count, i] = point + pull * normal
            count += 1
    return count

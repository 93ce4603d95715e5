"""Keep surface points where optical flow took them from the frame before, the O of [T16] §3.3 and §4.4.1."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.model.scene import PosedScene
from tracker.observation.image_flow import ImageFlow
from tracker.rendering import render_view
from tracker.terms.look import TermLook
from tracker.terms.point_line import PointToLine, find_slack
from tracker.terms.residual import FrameContext
from tracker.terms.surface_point import find_shares

Array = npt.NDArray[np.float64]

STRIDE = 8
"""Flow is used in one of this many rows and columns of the drawn pixels."""

RIM = 4
"""Pixels so near to a contour of the drawing are left out: the flow there may be of what lies behind, px."""

JUMP = 0.008
"""Depth step of a contour within the model, m, as in `Contours`."""


@dataclass(frozen=True)
class Flow:
    """Pull points of the surface to where the image has taken them: E = Σ wᵢ |v_i(θ) × d_i − m_i|², [T16] Eq. 8, 19.

    The weight of a point falls with its distance from its ray (`find_slack`).

    Differs from the paper: distances are of the surface point from the viewing ray, mm, not px (as in `Contours`).

    Attributes:
        ids: (N, 3) vertices of the scene that span each point.
        barycentric: (N, 3) their shares.
        directions: (N, 3) unit, world, of the rays through the pixels where the points are seen now.
        moments: (N, 3) world, m.
        weight: Of a point whose ray is near.
        reach: mm.
    """

    look: ClassVar[TermLook] = TermLook("flow", "Flow", "#87a578", "#695a3c", (1, 3))

    ids: npt.NDArray[np.int32]
    barycentric: Array
    directions: Array
    moments: Array
    weight: float = 0.05
    reach: float = 3.0

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToLine:
        """The same rays whatever the pose, with less weight where the point is far from its own."""
        points = np.einsum("nc,nci->ni", self.barycentric, posed.vertices[self.ids])
        weights = self.weight / find_slack(points, self.directions, self.moments, self.reach)
        return PointToLine(self.ids, self.barycentric, self.directions, self.moments, weights)


def follow_surface(before: PosedScene, flow: ImageFlow, stride: int = STRIDE) -> Flow:
    """The points of the surface that were seen in the frame before, on their rays of this frame.

    Args:
        before: The scene as it was fitted to the frame before.
        flow: From that frame to this one, in one view.
        stride: px between points.
    """
    height, width = flow.now.shape[:2]
    view = render_view(before, flow.K, flow.T_world_camera, height, width)
    depth = np.where(view.face >= 0, view.depth, 10.0).astype(np.float32)
    kernel = np.ones((2 * RIM + 1, 2 * RIM + 1), dtype=np.uint8)
    is_inside = (cv2.dilate(depth, kernel) - cv2.erode(depth, kernel) < RIM * JUMP) & (view.face >= 0)
    is_chosen = np.zeros_like(is_inside)
    is_chosen[stride // 2 :: stride, stride // 2 :: stride] = True
    rows, columns = np.nonzero(is_chosen & is_inside & np.isfinite(flow.now[:, :, 0]))
    ids = before.scene.arrays.faces[view.face[rows, columns]]
    barycentric = find_shares(ids, view.projected, columns, rows)
    pixels = flow.now[rows, columns].astype(np.float64)
    rays = np.column_stack([(pixels - flow.K[:2, 2]) / flow.K[[0, 1], [0, 1]], np.ones(len(pixels))])
    directions = rays @ flow.T_world_camera[:3, :3].T
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    origin = np.broadcast_to(flow.T_world_camera[:3, 3], directions.shape)
    moments = np.asarray(np.cross(origin, directions), dtype=np.float64)
    return Flow(ids, barycentric, directions, moments)


def join_flows(parts: Sequence[Flow], weight: float | None = None) -> Flow:
    """The points of several views in one term, with the first one's reach, and its weight unless told otherwise."""
    return replace(
        parts[0],
        ids=np.concatenate([part.ids for part in parts]),
        barycentric=np.concatenate([part.barycentric for part in parts]),
        directions=np.concatenate([part.directions for part in parts]),
        moments=np.concatenate([part.moments for part in parts]),
        weight=parts[0].weight if weight is None else weight,
    )

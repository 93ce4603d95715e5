"""Finger nails that a detector found in colour views, the S of [T16] §3.3: Eq. 14 in each view, Eq. 15 on rays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.detection.assignment import assign_detections
from tracker.geometry import se3
from tracker.model.scene import PosedScene
from tracker.rendering.seen_nails import NailPlaces
from tracker.terms.look import TermLook
from tracker.terms.marked_joints import find_rays
from tracker.terms.point_line import PointToLine, find_slack
from tracker.terms.residual import FrameContext

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class SeenNails:
    """Nails that were detected in one view.

    Attributes:
        camera: Without distortion.
        pixels: (S, 2) px.
        is_visible: (N,) which of the scene's nails the view should show.
    """

    camera: Camera
    pixels: Array
    is_visible: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Nails:
    """Keep nails on the viewing rays of the detections that are assigned to them: E = Σ w_i |v_i × d_i − m_i|².

    Which detection of a view is which nail that it should show is decided at every look by Eq. 14; w_st is how far the
    nail is from the ray, m.

    Differs from the paper: the distance is measured in space from the viewing ray (Eq. 8) in place of the image
    (Eq. 19), as all of our terms do; every pair counts, however near, for a nail tells where it is.

    Attributes:
        places: Of all nails of the scene.
        views: What was detected.
        weight: Of a nail; chosen on one motion (benchmarks/rendered_views/nails.py).
        rejection: λ of Eq. 14, m.
        reach: mm; a nail that far from its ray has a quarter of its pull.
    """

    look: ClassVar[TermLook] = TermLook("nails", "Nails", "#5af0a5", "#0f0f00", (2, 3))

    places: NailPlaces
    views: Sequence[SeenNails]
    weight: float = 0.3
    rejection: float = 0.015
    reach: float = 15.0

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToLine:
        """Assign detections to nails."""
        points = self.places.points(posed.vertices)
        chosen, directions, moments = [], [], []
        for view in self.views:
            rays = find_rays(view.pixels, view.camera)
            found = self.assign(view, points)
            is_used = found >= 0
            chosen.append(found[is_used])
            directions.append(rays[is_used])
            origin = np.broadcast_to(view.camera.T_world_camera[:3, 3], rays.shape)
            moments.append(np.cross(origin, rays)[is_used])
        nails = np.concatenate(chosen) if chosen else np.zeros(0, dtype=np.int64)
        d, m = (np.concatenate(parts) if parts else np.zeros((0, 3)) for parts in (directions, moments))
        weights = self.weight / find_slack(points[nails], d, m, self.reach)
        return PointToLine(self.places.ids[nails], self.places.shares[nails], d, m, weights)

    def assign(self, view: SeenNails, points: Array) -> npt.NDArray[np.int64]:
        """(S,) the nail of each detection of a view, -1 for none; `points` (N, 3) are where the nails are, world, m."""
        nails = np.flatnonzero(view.is_visible)
        if not len(nails) or not len(view.pixels):
            return np.full(len(view.pixels), -1)
        depths = np.maximum(se3.transform(view.camera.T_camera_world, points[nails])[:, 2], 1e-3)
        apart = np.linalg.norm(view.pixels[:, None] - view.camera.project(points[nails])[None], axis=2)
        distances = np.nan_to_num(apart * depths / view.camera.K[0, 0], nan=np.inf)
        found = assign_detections(distances, np.ones(len(view.pixels)), self.rejection)
        return np.where(found >= 0, nails[np.maximum(found, 0)], -1)

"""Edges of colour views around what is expected there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import CameraFrame
from tracker.fitting.map_views import map_views
from tracker.geometry import se3
from tracker.observation.image_edges import ImageEdges, find_image_edges

Array = npt.NDArray[np.float64]

EDGE_MARGIN = 0.015
"""m around the scene in which edges are looked for."""

NEAREST = 0.05
"""m before a camera; what is nearer is not drawn."""


def find_edges(vertices: Array, views: Sequence[CameraFrame], margin: float, threads: int = 1) -> dict[str, ImageEdges]:
    """Edges of each colour image that shows vertices (N, 3) world, m, and `margin` m around them, by its camera."""

    def look(view: CameraFrame) -> ImageEdges | None:
        points, pixels = find_place(vertices, view.camera, margin)
        color = view.frame.color
        return None if color is None or not len(points) else find_image_edges(color, view.camera, points, pixels)

    found = zip(views, map_views(look, views, threads), strict=True)
    return {view.camera.id: edges for view, edges in found if edges is not None}


def find_place(vertices: Array, camera: Camera, margin: float) -> tuple[Array, float]:
    """Where an ideal lens shows the vertices (N, 2) px that are well before a camera, and px of a margin (m) there."""
    points = se3.transform(camera.T_camera_world, vertices)
    points = points[points[:, 2] > NEAREST]
    if not len(points):
        return np.zeros((0, 2)), 0.0
    pixels = points[:, :2] / points[:, 2:] * camera.K[[0, 1], [0, 1]] + camera.K[:2, 2]
    return pixels, margin * float(camera.K[0, 0] / np.median(points[:, 2]))

"""How far the skin that the camera sees is from what it measured."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from tracker.fitting.frame_fit import label_scene
from tracker.model.scene import PosedScene
from tracker.observation import Observation
from tracker.rendering import View

VISIBLE_WITHIN = 0.003
"""A vertex is seen when it is at most this far behind the drawn surface, m."""


def measure_surface_fit(posed: PosedScene, view: View, seen: Observation) -> npt.NDArray[np.float32]:
    """(V,) distance, m, of each vertex of the scene to the nearest measured point that may belong to its model.

    NaN for vertices that the camera cannot see at this pose: of them the image says nothing. Points are as far apart as
    pixels are at their depth, so a perfect fit has distances of up to about half of that.

    Args:
        posed: The scene.
        view: The same, drawn as the observation's camera sees it.
        seen: The frame.
    """
    distances = np.full(len(posed.vertices), np.nan, dtype=np.float32)
    visible = _find_visible(posed, view)
    vertex_labels, _ = label_scene(posed.scene)
    for bit in np.unique(vertex_labels):
        chosen = np.flatnonzero(visible & (vertex_labels == bit))
        points = seen.points[(seen.labels & bit) > 0]
        if len(points) and len(chosen):
            distances[chosen] = KDTree(points).query(posed.vertices[chosen])[0]
    return distances


def _find_visible(posed: PosedScene, view: View) -> npt.NDArray[np.bool_]:
    height, width = view.inverse_depth.shape
    in_front = view.projected[:, 2] > 0.0
    columns, rows = np.rint(view.projected[:, :2]).astype(np.int64).T
    inside = in_front & (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    drawn = np.zeros(len(posed.vertices))
    drawn[inside] = view.inverse_depth[rows[inside], columns[inside]]
    depth = 1.0 / np.maximum(view.projected[:, 2], 1e-9)
    eye = -view.T_camera_world[:3, :3].T @ view.T_camera_world[:3, 3]
    faces_camera = np.einsum("vi,vi->v", posed.normals, eye - posed.vertices) > 0.0
    return inside & faces_camera & ((drawn <= 0.0) | (depth <= 1.0 / np.maximum(drawn, 1e-9) + VISIBLE_WITHIN))

"""Which joints a person would mark as seen: the third number of an annotated point, as in COCO."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import ABSENT, OCCLUDED, VISIBLE
from tracker.geometry import se3
from tracker.rendering.zbuffer import render_depth
from tracker.synthesis.performance import Moment, Performance

TOLERANCE = 0.003
"""A joint so little behind a surface's far side still counts as inside, m: tips lie on the surface itself."""


def find_visibility(performance: Performance, moment: Moment) -> npt.NDArray[np.int64]:
    """Say for every joint (J,) whether it is VISIBLE, OCCLUDED or ABSENT (outside the image).

    A joint is inside the flesh, so no image shows the joint itself. It counts as seen if the ray from the camera enters
    a body once and then reaches the joint: if it leaves a body before, that body is something else in the way.
    """
    camera = performance.camera
    vertices = se3.transform(camera.T_camera_world, moment.vertices)
    faces = performance.faces
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    is_far_side = np.einsum("fi,fi->f", normals, corners[:, 0]) > 0
    leaves = render_depth(vertices, faces[is_far_side], camera.K, camera.width, camera.height).depth

    depths = se3.transform(camera.T_camera_world, moment.joints)[:, 2]
    with np.errstate(invalid="ignore"):
        columns, rows = np.rint(moment.pixels).T
        is_inside = (columns >= 0) & (columns < camera.width) & (rows >= 0) & (rows < camera.height)
    result = np.full(len(depths), ABSENT)
    first_exit = leaves[rows[is_inside].astype(np.int64), columns[is_inside].astype(np.int64)]
    is_hidden = (first_exit > 0) & (first_exit < depths[is_inside] - TOLERANCE)
    result[is_inside] = np.where(is_hidden, OCCLUDED, VISIBLE)
    return result

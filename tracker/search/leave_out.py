"""A frame without what is already explained, and without forearms: sleeves are no skin, but no object either."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.model.joints import HAND_JOINTS
from tracker.model.scene import Scene
from tracker.rendering import render_view

Array = npt.NDArray[np.float64]

EXPLAINED = 0.02
"""A pixel this near to a drawn surface belongs to it, m."""

RADIUS = 0.055
"""Of a forearm in its sleeve, at the wrist, m."""

OPENING = 0.7
"""Metres that it may be aside a metre behind the wrist: a wrist bends."""

LENGTH = 0.40
"""m."""

CORE = 0.6
"""What has its middle within this share of the cone is inside the forearm."""


def leave_out(frame: Frame, camera: Camera, scene: Scene, pose: Array, models: list[int]) -> Frame:
    """The frame with no depth where some models (indices) of a scene at a pose (D,) explain it."""
    if not models or frame.depth is None:
        return frame
    view = render_view(scene.pose_at(pose), camera.K, camera.T_world_camera, camera.height, camera.width)
    drawn = view.face >= 0
    belongs = np.zeros_like(drawn)
    belongs[drawn] = np.isin(scene.face_models[view.face[drawn]], models)
    belongs &= np.abs(frame.depth - view.depth) < EXPLAINED
    return replace(frame, depth=np.where(belongs, np.float32(0.0), frame.depth))


def leave_out_forearms(frame: Frame, camera: Camera, hands: list[Array]) -> Frame:
    """The frame with no depth behind the wrists of hands, given by their joints (21, 3) world, m: in a cone about the
    direction from the middle knuckle to the wrist."""
    if frame.depth is None or not hands:
        return frame
    rows, columns = np.nonzero(frame.depth)
    points = camera.lift(np.stack([columns, rows], axis=1), frame.depth[rows, columns].astype(np.float64))
    depth = frame.depth.copy()
    for joints in hands:
        is_arm = _depth_in_cone(points, joints) < 1.0
        depth[rows[is_arm], columns[is_arm]] = 0.0
    return replace(frame, depth=depth)


def is_in_forearm(point: Array, hands: list[Array]) -> bool:
    """Whether a point (3,) world, m, lies in the forearm of a hand (21, 3): no object can have its middle there."""
    return any(bool(_depth_in_cone(point[None], joints)[0] < CORE) for joints in hands)


def _depth_in_cone(points: Array, joints: Array) -> Array:
    """(N,) distance from the forearm's axis as a share of the cone's radius there; infinite before and behind it."""
    wrist, knuckle = joints[HAND_JOINTS.index("wrist")], joints[HAND_JOINTS.index("middle_mcp")]
    backwards = (wrist - knuckle) / max(float(np.linalg.norm(wrist - knuckle)), 1e-9)
    behind = (points - wrist) @ backwards
    aside = np.linalg.norm(points - wrist - behind[:, None] * backwards, axis=1)
    share = aside / np.maximum(RADIUS + OPENING * behind, 1e-9)
    return np.where((behind > 0.0) & (behind < LENGTH), share, np.inf)

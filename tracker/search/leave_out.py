"""A frame without what is already explained."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.model.scene import Scene
from tracker.rendering import render_view

EXPLAINED = 0.02
"""A pixel this near to a drawn surface belongs to it, m."""


def leave_out(frame: Frame, camera: Camera, scene: Scene, pose: npt.NDArray[np.float64], models: list[int]) -> Frame:
    """The frame with no depth where some models (indices) of a scene at a pose (D,) explain it."""
    if not models or frame.depth is None:
        return frame
    view = render_view(scene.pose_at(pose), camera.K, camera.T_world_camera, camera.height, camera.width)
    drawn = view.face >= 0
    belongs = np.zeros_like(drawn)
    belongs[drawn] = np.isin(scene.face_models[view.face[drawn]], models)
    belongs &= np.abs(frame.depth - view.depth) < EXPLAINED
    return replace(frame, depth=np.where(belongs, np.float32(0.0), frame.depth))

"""A hand before three colour cameras, as the swarm is shown it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from benchmarks.baselines.drawing import Canvas, Drawing
from benchmarks.baselines.skin_view import SkinView
from tests.tracker.scenes import drawn_hand
from tracker.capture.camera import Camera
from tracker.capture.frame import CameraFrame, Frame
from tracker.model.scene import Scene
from tracker.rendering import render_view
from tracker.synthesis.camera_ring import surround
from tracker.synthesis.shading import BACKGROUND, SKIN, encode

STEP_MM = 4.5


@dataclass(frozen=True)
class SeenHand:
    """A hand, the pose it has and three cameras around it."""

    scene: Scene
    pose: np.ndarray
    cameras: tuple[Camera, ...]

    def maps(self, pose: np.ndarray) -> list[SkinView]:
        """What the cameras show of a pose, every third pixel, without noise: edges are those of the drawing."""
        views = []
        vertices = self.scene.pose_at(pose).vertices
        for camera in self.cameras:
            K = camera.K.copy()
            K[:2] /= 3.0
            canvas = Canvas(K, camera.T_world_camera, (80, 107))
            drawing = Drawing(self.scene, (canvas,))
            drawing.draw(vertices)
            is_hand = drawing.face >= 0
            depth = np.where(is_hand, 1.0 / np.maximum(drawing.inverse_depth, 0.1), 10.0)
            lowest, highest = (fold(depth, np.ones((3, 3), np.uint8)) for fold in (cv2.erode, cv2.dilate))
            far = cv2.distanceTransform((highest - lowest < 0.01).astype(np.uint8), cv2.DIST_L2, 5)
            views.append(SkinView(canvas, is_hand, STEP_MM * far.astype(np.float32), STEP_MM))
        return views

    def photographs(self, pose: np.ndarray) -> list[CameraFrame]:
        """Plain colour images of a pose, lit from each camera."""
        frames = []
        for camera in self.cameras:
            view = render_view(self.scene.pose_at(pose), camera.K, camera.T_world_camera, camera.height, camera.width)
            image = np.empty((camera.height, camera.width, 3))
            image[:] = encode(np.array(BACKGROUND))
            is_hand = view.face >= 0
            light = np.abs(view.face_normals[view.face[is_hand]] @ camera.T_world_camera[:3, 2])
            image[is_hand] = encode(np.array(SKIN) * (0.45 + 0.55 * light)[:, None])
            color = np.clip(np.rint(image), 0, 255).astype(np.uint8)
            frames.append(CameraFrame(camera, Frame(0, camera.id, color, None)))
        return frames


def seen_hand() -> SeenHand:
    """The default right hand at rest, 0.45 m before three cameras of 320x240 px."""
    drawn = drawn_hand()
    center = drawn.scene.pose_at(drawn.pose).vertices.mean(axis=0)
    return SeenHand(drawn.scene, drawn.pose, (drawn.camera, *surround(drawn.camera, center, 2)))

"""A small drawn scene: what a noise-free camera would see of a bent tube."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.tracker.toys import tube
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.frame_fit import label_scene
from tracker.fitting.region import region_around
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.model.scene import PosedScene, Scene
from tracker.observation import Observation, Preprocessing, observe
from tracker.rendering import render_depth, render_view
from tracker.terms.residual import FrameContext

K = np.array([[300.0, 0.0, 159.5], [0.0, 300.0, 119.5], [0.0, 0.0, 1.0]])
CAMERA = Camera("cam0", 320, 240, K)


@dataclass(frozen=True)
class DrawnScene:
    """A scene, the pose it was drawn at, the camera and what was seen."""

    scene: Scene
    pose: np.ndarray
    camera: Camera
    frame: Frame
    observation: Observation

    def context(self, posed: PosedScene) -> FrameContext:
        height, width = self.observation.labels.shape
        view = render_view(posed, self.observation.K, self.observation.T_world_camera, height, width)
        return FrameContext(view, self.observation, *label_scene(self.scene))

    def disturbed(self, rng: np.random.Generator, angle: float = 0.05, shift: float = 0.006) -> np.ndarray:
        """The pose with angles off by `angle`, rad, and the root by `shift`, m."""
        step = rng.normal(scale=angle, size=self.scene.num_dofs)
        step[:3] = rng.normal(scale=shift, size=3)
        return self.scene.retract(self.pose, step)


def drawn_tube(T_world_camera: np.ndarray | None = None) -> DrawnScene:
    """A tube of three bones at 0.3 m before a camera that may stand anywhere in the world."""
    T_world_camera = np.eye(4) if T_world_camera is None else T_world_camera
    scene = Scene((tube(bones=3, rings=25, sides=16, radius=0.012),))
    pose = scene.rest_pose()
    in_camera = se3.exp(np.array([-0.045, 0.0, 0.3, 0.0, 0.0, 0.0])) @ se3.exp(np.array([0, 0, 0, 0.2, 0.3, 0.1]))
    pose[:6] = se3.log(T_world_camera @ in_camera)
    pose[6:] = [0.4, -0.3, 0.5, 0.2]
    return draw_scene(scene, pose, T_world_camera)


def drawn_hand() -> DrawnScene:
    """The default right hand at rest, 0.45 m before a camera at the origin."""
    scene = Scene((default_hand("right"),))
    pose = scene.rest_pose()
    pose[:3] = np.array([0.0, 0.0, 0.45]) - scene.pose_at(pose).vertices.mean(axis=0)
    return draw_scene(scene, pose, np.eye(4))


def draw_scene(scene: Scene, pose: np.ndarray, T_world_camera: np.ndarray) -> DrawnScene:
    """A scene as a camera of 320x240 px sees it, without noise."""
    camera = Camera("cam0", 320, 240, K, T_world_camera=T_world_camera)
    vertices = scene.pose_at(pose).vertices
    rendering = render_depth(se3.transform(se3.inverse(T_world_camera), vertices), scene.arrays.faces, K, 320, 240)
    frame = Frame(0, "cam0", None, rendering.depth.astype(np.float32))
    region = region_around(vertices, camera)
    assert region is not None
    seen = observe(frame, camera, region, Preprocessing(bilateral_diameter=0, objects=True))
    return DrawnScene(scene, pose, camera, frame, seen)


def palm_to_camera(model: ArticulatedModel, place: tuple[float, float, float], curl: float = 0.0) -> np.ndarray:
    """(D,) of one hand: palm to a camera at the origin, fingers up or curled, its middle knuckle at a place, m."""
    scene = Scene((model,))
    joints = scene.pose_at(scene.rest_pose()).landmarks(0)
    up = (joints[9] - joints[0]) / np.linalg.norm(joints[9] - joints[0])
    out = np.cross(up, joints[5] - joints[17]) * (1.0 if model.hand and model.hand.side == "right" else -1.0)
    out /= np.linalg.norm(out)
    T = np.eye(4)
    T[:3, :3] = np.stack([np.cross(-up, out), -up, out])
    T[:3, 3] = place - T[:3, :3] @ joints[9]
    return np.concatenate([se3.log(T), curl_fingers(model, curl)])


def photograph(scene: Scene, pose: np.ndarray, camera: Camera = CAMERA) -> Frame:
    """What a noise-free camera sees of a scene before nothing, and which of its pixels are of a hand."""
    view = render_view(scene.pose_at(pose), camera.K, camera.T_world_camera, camera.height, camera.width)
    is_hand_model = np.array([model.hand is not None for model in scene.models])
    is_hand = (view.face >= 0) & is_hand_model[scene.face_models[view.face]]
    return Frame(0, camera.id, None, view.depth.astype(np.float32), is_hand)


def move_pose(scene: Scene, T: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """The pose (D,) with every model moved by T (4, 4), world."""
    moved = pose.copy()
    for where in scene.pose_slices:
        root = slice(where.start, where.start + 6)
        moved[root] = se3.log(T @ se3.exp(pose[root]))
    return moved

"""A tube that bends before a camera."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.capture.camera import Camera
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.synthesis.actor import Actor
from tracker.synthesis.performance import Performance


@pytest.fixture
def camera() -> Camera:
    """Not at the origin, so that world and camera cannot be mixed up unnoticed."""
    T_world_camera = se3.exp(np.array([0.1, -0.2, 0.3, 0.2, -0.3, 0.1]))
    return Camera(
        "cam0", 160, 120, np.array([[150.0, 0, 79.5], [0, 150.0, 59.5], [0, 0, 1]]), T_world_camera=T_world_camera
    )


def bending_tube(camera: Camera, name: str, z: float, num_moments: int = 6) -> Actor:
    """A tube across the image at depth z, m, that bends a little more at every moment."""
    model = tube(radius=0.012, length=0.04)
    scene = Scene((model,))
    T_camera_model = np.eye(4)
    T_camera_model[:3, 3] = [-0.06, 0.0, z]
    Ms = []
    for moment in range(num_moments):
        pose = scene.rest_pose()
        pose[:6] = se3.log(camera.T_world_camera @ T_camera_model)
        pose[6:] = 0.08 * moment
        Ms.append(scene.pose_at(pose).Ms)
    return Actor(name, model, np.array(Ms), (0.05, 0.35, 0.12))


@pytest.fixture
def performance(camera) -> Performance:
    return Performance("a bending tube", 30.0, camera, (bending_tube(camera, "tube", 0.4),))

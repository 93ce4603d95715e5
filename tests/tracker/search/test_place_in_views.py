"""Where a hand starts whose joints several colour views saw."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.view_hands import ViewHands
from tracker.geometry import se3
from tracker.landmarks import DetectedHand
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.search.place_in_views import place_in_views

K = np.array([[600.0, 0.0, 320.0], [0.0, 600.0, 240.0], [0.0, 0.0, 1.0]])
HAND = default_hand("right")
SCENE = Scene((HAND,))
DETECTOR_NOISE = 2.0
"""px, of a hand about 100 px long."""


def look_from(angle: float, distance: float = 0.8) -> Camera:
    """A camera on a circle around the origin, slightly distorted, looking at it."""
    forward = -np.array([np.sin(angle), 0.2, -np.cos(angle)])
    forward /= np.linalg.norm(forward)
    right = np.cross([0.0, 1.0, 0.0], forward)
    right /= np.linalg.norm(right)
    T = np.eye(4)
    T[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    T[:3, 3] = -distance * forward
    return Camera(f"cam{angle:.1f}", 640, 480, K, np.array([-0.1, 0.02, 0.001, -0.001, 0.0]), T)


@pytest.fixture(scope="module")
def joints() -> np.ndarray:
    """(21, 3) of a half-closed hand about the origin, m."""
    pose = SCENE.rest_pose()
    pose[6:] = curl_fingers(HAND, 0.5)
    T = se3.exp(np.array([0.0, 0.0, 0.0, 0.6, -0.4, 0.9]))
    T[:3, 3] -= (T @ np.append(SCENE.pose_at(pose).landmarks(0).mean(axis=0), 1.0))[:3]
    pose[:6] = se3.log(T @ se3.exp(pose[:6]))
    return SCENE.pose_at(pose).landmarks(0)


def see(joints: np.ndarray, cameras: list[Camera], rng: np.random.Generator) -> ViewHands:
    """What a detector with noise tells of the joints in every view."""
    hands = []
    for camera in cameras:
        points = camera.project(joints) + rng.normal(0.0, DETECTOR_NOISE, (21, 2))
        points_3d = 1.1 * (joints - joints.mean(axis=0)) @ camera.T_camera_world[:3, :3].T  # a size of its own
        hands.append({"right": DetectedHand(points, points_3d, 1.0, 1.0)})
    return ViewHands(tuple(cameras), tuple(hands))


def error_mm(seen: ViewHands, joints: np.ndarray) -> float:
    pose = place_in_views(HAND, "right", seen)
    assert pose is not None
    return 1000.0 * float(np.linalg.norm(SCENE.pose_at(pose).landmarks(0) - joints, axis=1).mean())


@pytest.mark.parametrize("views", [2, 3, 8])
def test_a_hand_is_placed_on_the_joints_of_all_views(joints, views, rng):
    cameras = [look_from(angle) for angle in np.linspace(0.0, 1.8, views)]
    assert error_mm(see(joints, cameras, rng), joints) < 4.0


def test_a_view_that_saw_something_else_is_not_believed(joints, rng):
    cameras = [look_from(angle) for angle in (0.0, 0.7, 1.4)]
    right = see(joints, cameras, rng)
    elsewhere = see(joints + np.array([0.15, 0.1, 0.0]), cameras, rng)
    mixed = ViewHands(right.cameras, (elsewhere.hands[0], *right.hands[1:]))
    assert error_mm(mixed, joints) < 5.0
    posed = SCENE.pose_at(place_in_views(HAND, "right", mixed))
    assert (mixed.measure(posed, 0, "right") < 0.5).tolist() == [False, True, True]


def test_one_view_tells_the_distance_by_the_hands_size(joints, rng):
    camera = look_from(0.4)
    pose = place_in_views(HAND, "right", see(joints, [camera], rng))
    found = SCENE.pose_at(pose).landmarks(0)
    assert np.linalg.norm(camera.project(found) - camera.project(joints), axis=1).mean() < 2 * DETECTOR_NOISE
    assert abs(np.linalg.norm(found.mean(axis=0) - camera.T_world_camera[:3, 3]) - 0.8) < 0.06


def test_what_no_view_saw_is_not_placed(joints):
    camera = look_from(0.0)
    assert place_in_views(HAND, "right", ViewHands((camera, camera), ({}, {}))) is None

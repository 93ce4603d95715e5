"""Joints on viewing rays: those that are told wrongly let go."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.terms.marked_joints import mark_joints


@pytest.fixture
def seen():
    K = np.array([[525.0, 0, 319.5], [0, 525.0, 239.5], [0, 0, 1]])
    camera = Camera("cam0", 640, 480, K, np.zeros(0), np.eye(4))
    scene = Scene((default_hand("right"),))
    pose = scene.rest_pose()
    pose[:6] = se3.log(np.block([[np.eye(3), np.array([[0.0], [0.0], [0.6]])], [np.zeros((1, 3)), np.ones((1, 1))]]))
    posed = scene.pose_at(pose)
    return camera, scene, posed, camera.project(posed.landmarks(0))


def test_rays_go_through_their_joints(seen):
    camera, scene, posed, points = seen
    marks = mark_joints(scene, 0, np.column_stack([points, np.full(21, 2.0)]), camera)
    apart = np.cross(posed.vertices[marks.ids], marks.directions) - marks.moments
    assert np.abs(apart).max() < 1e-9
    np.testing.assert_array_equal(marks.find(posed).weights, np.ones(21))


def test_a_joint_that_is_not_marked_has_no_ray(seen):
    camera, scene, posed, points = seen
    visible = np.full(21, 2.0)
    visible[3:7] = 0.0
    assert mark_joints(scene, 0, np.column_stack([points, visible]), camera).find(posed).count == 17


def test_a_joint_far_from_its_ray_lets_go_and_one_that_is_not_believed_pulls_less(seen):
    camera, scene, posed, points = seen
    points = points.copy()
    points[8, 0] += 525.0 * 0.015 / posed.landmarks(0)[8, 2]  # 15 mm aside
    points[12, 0] += 525.0 * 0.150 / posed.landmarks(0)[12, 2]
    beliefs = np.ones(21)
    beliefs[4] = 0.25
    marks = mark_joints(scene, 0, np.column_stack([points, np.full(21, 2.0)]), camera, beliefs, reach=15.0)
    weights = marks.find(posed).weights
    assert weights[0] == pytest.approx(1.0)
    assert weights[4] == pytest.approx(0.25)
    assert weights[8] == pytest.approx(0.25, rel=0.15)  # (1 + 1)^-2; the ray is nearer than its pixel
    assert weights[12] < 3e-4

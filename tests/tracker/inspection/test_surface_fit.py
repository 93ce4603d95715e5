"""Distances of the skin that is seen from what was measured; of the rest nothing is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.scenes import CAMERA, move_pose, palm_to_camera, photograph
from tracker.capture.frame import Frame
from tracker.fitting.frame_fit import draw
from tracker.fitting.region import whole_image
from tracker.geometry import se3
from tracker.inspection.surface_fit import measure_surface_fit
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.observation import Preprocessing, observe

HAND = default_hand("right")
SCENE = Scene((HAND, ball(0.03)))
POSE = np.r_[palm_to_camera(HAND, (-0.03, 0.0, 0.45)), 0.11, 0.0, 0.45, 0.0, 0.0, 0.0]
FRAME = photograph(SCENE, POSE)
SKIN, BALL = SCENE.vertex_slices
PIXEL = 0.45 / CAMERA.K[0, 0]
"""How far apart pixels are on the hand, m."""


def measure(frame: Frame = FRAME, pose: np.ndarray = POSE, camera=CAMERA, how: Preprocessing | None = None):
    how = how or Preprocessing(bilateral_diameter=0, objects=True)
    seen = observe(frame, camera, whole_image(camera, 0.1, 3.0), how)
    posed = SCENE.pose_at(pose)
    return measure_surface_fit(posed, draw(posed, seen), seen)


def test_the_side_towards_the_camera_lies_on_the_data_and_of_the_other_nothing_is_said():
    distances = measure()
    assert distances.shape == (len(SCENE.pose_at(POSE).vertices),)
    facing = SCENE.pose_at(POSE).normals[:, 2]
    known = np.isfinite(distances)
    assert np.all(facing[known] < 0.2) and not known[facing > 0.2].any()
    assert known[SKIN].mean() > 0.25 and known[BALL].mean() > 0.25
    assert np.median(distances[known]) < PIXEL and np.percentile(distances[known], 95) < 3.0 * PIXEL


@pytest.mark.parametrize("off", [0.004, 0.008])
def test_a_hand_that_is_off_is_measured_about_as_far_off(off):
    away = move_pose(SCENE, se3.exp(np.array([0.0, 0.0, off, 0, 0, 0])), POSE)
    distances = measure(pose=away)
    palm = np.isfinite(distances[SKIN]) & (SCENE.pose_at(away).normals[SKIN, 2] < -0.9)
    assert np.median(distances[SKIN][palm]) == pytest.approx(off, rel=0.15)


def test_what_is_hidden_by_another_model_is_not_seen():
    before = POSE.copy()
    before[-6:-3] = (-0.03, 0.02, 0.3)  # the ball before the palm
    distances, free = measure(photograph(SCENE, before), before), measure()
    hidden = np.isfinite(free[SKIN]) & ~np.isfinite(distances[SKIN])
    assert np.count_nonzero(hidden) > 20
    assert np.nanmax(distances[SKIN]) < 0.01, "no vertex of the palm is compared with the ball"


def test_where_colour_tells_hand_from_other_things_each_is_compared_with_its_own():
    hidden = replace(FRAME, depth=np.where(FRAME.is_hand, FRAME.depth, np.float32(0.0)))
    distances = measure(hidden)
    assert not np.isfinite(distances[BALL]).any() and np.isfinite(distances[SKIN]).any()
    both = measure(hidden, how=Preprocessing(bilateral_diameter=0, objects=True, use_skin=False))
    assert np.nanmin(both[BALL]) > 0.0, "without colour any point may be the ball's"


def test_camera_and_scene_moved_together_are_measured_alike():
    T = se3.exp(np.array([0.4, 1.0, -2.0, 0.5, -1.2, 2.0]))
    there = replace(CAMERA, T_world_camera=T)
    moved = measure(photograph(SCENE, move_pose(SCENE, T, POSE), there), move_pose(SCENE, T, POSE), there)
    here = measure()
    both = np.isfinite(here) & np.isfinite(moved)
    assert np.count_nonzero(np.isfinite(here) != np.isfinite(moved)) < 0.01 * len(here)
    assert np.abs(here[both] - moved[both]).mean() < 2e-4


def test_an_empty_image_and_a_scene_out_of_sight_say_nothing():
    empty = replace(FRAME, depth=np.zeros_like(FRAME.depth))
    assert not np.isfinite(measure(empty)).any()
    for shift in ((2.0, 0, 0), (0, 0, -1.0)):
        away = move_pose(SCENE, se3.exp(np.array([*shift, 0, 0, 0])), POSE)
        assert not np.isfinite(measure(pose=away)).any()

"""What is measured of a drawn object: its outline and depth, hands and other things before it apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball, cube
from tests.tracker.scenes import CAMERA, move_pose, photograph
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.frame_fit import draw
from tracker.fitting.object_quality import FEW, TOUCHING, ObjectQuality, measure_object_quality
from tracker.fitting.region import whole_image
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.observation import Preprocessing, observe

SCENE = Scene((cube(0.05),))
POSE = se3.log(se3.exp(np.array([0.0, 0.0, 0.5, 0.0, 0.0, 0.0])) @ se3.exp(np.array([0.0, 0.0, 0.0, 0.5, 0.6, 0.2])))


def judge(frame: Frame, pose: np.ndarray = POSE, scene: Scene = SCENE, model: int = 0, camera: Camera = CAMERA):
    seen = observe(frame, camera, whole_image(camera, 0.1, 3.0), Preprocessing(bilateral_diameter=0))
    return measure_object_quality(draw(scene.pose_at(pose), seen), seen, model)


def paint(frame: Frame, where, depth: float, is_hand: bool = False) -> Frame:
    assert frame.depth is not None and frame.is_hand is not None
    painted, labels = frame.depth.copy(), frame.is_hand.copy()
    painted[where], labels[where] = depth, is_hand
    return replace(frame, depth=painted, is_hand=labels)


def test_an_object_where_it_was_drawn_is_seen_whole_and_one_that_is_not_there_is_lost():
    quality = judge(photograph(SCENE, POSE))
    assert (quality.inside, quality.outline_iou, quality.status) == (1.0, 1.0, "ok")
    assert quality.score > 1.0 - 1e-5 and quality.depth_residual < 1e-7
    empty = paint(photograph(SCENE, POSE), np.s_[:, :], 0.0)
    assert judge(empty).status == "lost" and judge(empty).score == 0.0
    assert judge(paint(empty, np.s_[:, :], 0.8)).status == "lost", "the wall behind is seen through it"


def test_object_and_camera_moved_together_are_measured_alike():
    wrong = SCENE.retract(POSE, np.array([0.004, 0.003, 0.005, 0.1, 0.2, 0.1]))
    T = se3.exp(np.array([0.4, 1.0, -2.0, 0.5, -1.2, 2.0]))
    here = judge(photograph(SCENE, POSE), wrong)
    there = replace(CAMERA, T_world_camera=T)
    moved = judge(photograph(SCENE, move_pose(SCENE, T, POSE), there), move_pose(SCENE, T, wrong), camera=there)
    assert moved.score == pytest.approx(here.score, abs=0.01)
    assert moved.outline_iou == pytest.approx(here.outline_iou, abs=0.01)
    assert here.score < 0.9


def test_the_farther_an_object_is_from_its_place_the_worse_it_is():
    frame = photograph(SCENE, POSE)
    scores = [judge(frame, POSE + np.r_[shift, np.zeros(5)]).score for shift in (0.0, 0.003, 0.008, 0.02, 0.04)]
    assert scores == sorted(scores, reverse=True) and scores[-1] < 0.35 < 0.75 < scores[1]


def test_a_hand_or_a_thing_before_an_object_hides_it_and_takes_nothing_from_it():
    whole = photograph(SCENE, POSE)
    for is_hand in (True, False):
        quality = judge(paint(whole, np.s_[:125, :], 0.3, is_hand))
        assert (quality.inside, quality.outline_iou) == (1.0, 1.0)
        assert 0 < quality.visible < judge(whole).visible
        assert judge(paint(whole, np.s_[:, :], 0.3, is_hand)).status == "hidden"


@pytest.mark.parametrize(("behind", "inside"), [(0.5 * TOUCHING, 1.0), (3.0 * TOUCHING, 0.5)])
def test_skin_hides_an_object_up_to_the_thickness_of_a_touch_behind_it_and_no_farther(behind, inside):
    ball_scene = Scene((ball(0.03),))
    pose = np.array([0.0, 0.0, 0.5, 0.0, 0.0, 0.0])
    frame = photograph(ball_scene, pose)
    assert frame.depth is not None
    half = np.zeros_like(frame.depth, dtype=np.bool_)
    half[:120] = frame.depth[:120] > 0
    touched = paint(frame, half, (frame.depth + np.float32(behind))[half], True)
    assert judge(touched, pose, ball_scene).inside == pytest.approx(inside, abs=0.03)


def test_a_larger_thing_at_its_depth_is_not_the_object_and_one_far_behind_is_no_matter():
    ball_scene, pose = Scene((ball(0.02),)), np.array([0.0, 0.0, 0.5, 0.0, 0.0, 0.0])
    larger = photograph(Scene((ball(0.03),)), pose + np.r_[0.0, 0.0, 0.01, np.zeros(3)])
    assert judge(larger, pose, ball_scene).inside == 1.0
    assert judge(larger, pose, ball_scene).outline_iou < 0.6
    wall = photograph(ball_scene, pose)
    assert wall.depth is not None
    assert judge(paint(wall, wall.depth == 0, 0.7), pose, ball_scene).outline_iou == 1.0


def test_of_two_objects_each_is_judged_alone_and_in_either_order():
    both, swapped = Scene((cube(0.05), ball(0.03))), Scene((ball(0.03), cube(0.05)))
    beside = np.array([0.065, 0.0, 0.5, 0.0, 0.0, 0.0])
    wrong = beside + np.r_[0.0, 0.01, np.zeros(4)]
    frame = photograph(both, np.r_[POSE, beside])
    assert judge(frame, np.r_[POSE, wrong], both, 1) == judge(frame, np.r_[wrong, POSE], swapped, 0)
    good = judge(frame, np.r_[POSE, beside], both, 0)
    assert good.outline_iou == 1.0
    assert judge(frame, POSE).outline_iou < 1.0, "without a model of the ball its pixels near by seem the cube's"


@pytest.mark.parametrize(("pixels", "is_hidden"), [(FEW - 1, True), (FEW, False)])
def test_of_an_object_that_shows_too_little_nothing_is_said(pixels, is_hidden):
    bad = ObjectQuality(pixels, 0.0, float("inf"), 0.0, 0.0)
    assert bad.is_hidden is is_hidden
    assert bad.status == ("hidden" if is_hidden else "lost")


def test_an_object_out_of_the_image_is_hidden_as_one_that_is_nowhere():
    aside = POSE + np.r_[3.0, np.zeros(5)]
    assert judge(photograph(SCENE, POSE), aside) == ObjectQuality.of_nothing()
    assert ObjectQuality.of_nothing().status == "hidden"

"""Two hands that cross their fingers or pass a ball: near each other, and hardly into each other."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.ball import make_ball
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.synthesis.ball import RADIUS
from tracker.synthesis.interplay import CENTER, find_poses, find_spreading, play
from tracker.terms.penetration import measure_penetration

HANDS = {side: default_hand(side) for side in ("right", "left")}
MOMENTS = 7


@pytest.fixture(scope="module", params=["crossing", "passing"])
def posed(request):
    balls = (make_ball(RADIUS),) if request.param == "passing" else ()
    scene = Scene((*HANDS.values(), *balls))
    return [scene.pose_at(pose) for pose in find_poses(scene, request.param, MOMENTS)]


def test_hands_meet_and_hardly_enter_each_other(posed):
    gaps = [np.linalg.norm(each.landmarks(0)[:, None] - each.landmarks(1)[None], axis=2).min() for each in posed]
    assert min(gaps) < 0.030 < max(gaps)
    for each in posed:
        assert 1000.0 * measure_penetration(each) < 6.0


@pytest.mark.slow
def test_fingers_that_cross_at_the_moments_of_the_study_stay_out_of_each_other():
    scene = Scene(tuple(HANDS.values()))
    middle = find_poses(scene, "crossing", 144)[40:104:4]
    assert max(1000.0 * measure_penetration(scene.pose_at(pose)) for pose in middle) < 1.5


def test_the_hands_are_about_what_the_cameras_look_at(posed):
    joints = np.array([np.concatenate([each.landmarks(0), each.landmarks(1)]) for each in posed])
    assert np.linalg.norm(joints.mean(axis=(0, 1)) - CENTER) < 0.06


def test_spreading_takes_fingers_apart():
    hand = HANDS["right"]
    scene = Scene((hand,))
    pose = scene.rest_pose()
    tips = [8, 16, 20]
    before = scene.pose_at(pose).landmarks(0)
    pose[6:] = find_spreading(hand)
    after = scene.pose_at(pose).landmarks(0)
    for tip in tips:
        assert np.linalg.norm(after[tip] - after[12]) > np.linalg.norm(before[tip] - before[12]) + 0.005


def test_a_performance_has_its_cameras_and_both_hands():
    performance = play(HANDS, "passing", 3, 4, (320, 180))
    assert [actor.name for actor in performance.actors] == ["right", "left", "ball"]
    assert len(performance.cameras) == 4
    for camera in performance.cameras:
        assert camera.can_see(performance.hands[0].joints(1, performance.hands[0].vertices(1))).all()

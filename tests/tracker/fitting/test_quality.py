"""A followed hand and a lost one look different in numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.frame_fit import draw
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.quality import MISFIT, Quality
from tracker.fitting.region import region_around
from tracker.observation import observe


def judge(recorded, run, pose) -> Quality:
    setup, _, _, _ = run
    frame, camera = setup.read(recorded.sequence, 3)
    region = region_around(setup.scene.pose_at(pose).vertices, camera)
    seen = observe(frame, camera, region, setup.preprocessing)
    return measure_quality(draw(setup.scene.pose_at(pose), seen), seen)


def test_the_right_pose_explains_the_frame(recorded, run):
    quality = judge(recorded, run, run[3].pose[3])
    assert not quality.is_lost
    assert quality.score > 0.85
    assert quality.explained > 0.95
    assert quality.depth_residual < 1.5e-3  # m


def test_a_hand_beside_the_hand_is_lost(recorded, run):
    setup, pose = run[0], run[3].pose[3]
    beside = setup.scene.retract(pose, np.r_[0.08, 0, 0, 0, 0, 0, np.zeros(31)])
    assert judge(recorded, run, beside).is_lost


def test_a_fist_on_an_open_hand_is_worse_in_every_way(recorded, run):
    pose = run[3].pose[3].copy()
    right = judge(recorded, run, pose)
    pose[6:] = curl_fingers(run[0].models[0], 0.9)
    wrong = judge(recorded, run, pose)
    assert wrong.score < right.score - 0.1
    assert wrong.explained < right.explained
    assert wrong.merit < right.merit


def test_a_hand_turned_end_to_end_does_not_pass_its_fingers_off_as_a_forearm(recorded, run):
    setup, pose = run[0], run[3].pose[3].copy()
    right = judge(recorded, run, pose)
    pose[6:] = curl_fingers(setup.models[0], 0.9)
    posed = setup.scene.pose_at(pose)
    joints = posed.landmarks(0)
    axis = np.cross(joints[9] - joints[0], joints[5] - joints[17])
    turned = setup.scene.retract(pose, np.r_[joints[9] - joints[0], np.pi * axis / np.linalg.norm(axis), np.zeros(31)])
    assert judge(recorded, run, turned).merit < right.merit - 0.2


@pytest.mark.parametrize(("misfit", "is_lost"), [(0.0, False), (5e-5, False), (1e-4, True)])
def test_a_hand_that_was_seen_elsewhere_is_lost_only_where_the_depth_leaves_some_misfit(misfit, is_lost):
    followed = Quality(0.002, 0.9, 0.9, 0.9, 0.8, 0.9, misfit, 0.0, 4e-3, 0.9, 1.0)
    assert followed.is_lost is is_lost


@pytest.mark.parametrize(
    ("misfit", "broad", "worst_finger", "is_lost"),
    [
        (0.0, 0.0, None, False),
        (2e-4, 0.0, None, True),
        (2e-3, 0.0, 1.0, False),
        (2e-3, 2e-4, 0.2, False),
        (2e-3, 2e-4, 0.9, True),
    ],
)
def test_where_the_detector_saw_a_hand_it_and_the_depth_must_both_say_that_a_finger_is_elsewhere(
    misfit, broad, worst_finger, is_lost
):
    followed = Quality(0.002, 0.9, 0.9, 0.9, 0.8, 0.9, misfit, broad, 4e-3, 0.1, worst_finger)
    assert not followed.is_gone
    assert followed.is_lost is is_lost


def test_a_detector_that_was_told_where_to_look_does_not_talk_misfit_away(recorded, run):
    """One that sees the hand by itself does: a real hand of another shape leaves misfit with every finger in place."""
    seen = replace(judge(recorded, run, run[3].pose[3]), misfit=2.0 * MISFIT, apart=0.1, worst_finger=0.2)
    assert not seen.is_lost
    assert replace(seen, is_led=True).is_lost and replace(seen, apart=None, worst_finger=None).is_lost

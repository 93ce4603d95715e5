"""The listed poses: 51 of them, of hands that can be bent so."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.model.test_hand_axes import flat_hand
from tracker.model.hand_axes import LIMITS_DEG
from tracker.model.hand_skeleton import hand_bone_names
from tracker.model.joints import FINGERS
from tracker.synthesis.scans.pose_list import EXPLORATION, FISTS, GRASPS, MIXED, POSE_NAMES, POSES, HandPose

every_pose = pytest.mark.parametrize("pose", POSES, ids=POSE_NAMES)
SLACK = 10.0
"""Degrees by which a listed angle may pass a limit; it is cut there when it is taken."""


def test_there_are_51_poses_of_three_kinds_with_names_of_their_own() -> None:
    assert (len(EXPLORATION), len(GRASPS), len(MIXED)) == (14, 31, 6)
    assert len(POSES) == len(set(POSE_NAMES)) == 51
    assert all(name.replace("_", "").isalnum() and name.islower() for name in POSE_NAMES)


def test_a_fifth_of_all_poses_are_fists_whose_fingers_are_bent_most() -> None:
    assert set(FISTS) <= set(POSE_NAMES) and len(FISTS) == len(set(FISTS)) == round(51 / 5)

    def bend(pose: HandPose) -> float:
        return float(np.mean([pose.index, pose.middle, pose.ring, pose.little]))

    fists = [bend(pose) for pose in POSES if pose.name in FISTS]
    others = [bend(pose) for pose in POSES if pose.name not in FISTS]
    assert min(fists) > np.percentile(others, 75)


@every_pose
def test_no_finger_is_bent_much_farther_than_a_finger_can_be(pose: HandPose) -> None:
    for finger in FINGERS[1:]:
        for segment, angle in zip(("proximal", "middle", "distal"), getattr(pose, finger), strict=True):
            low, high = LIMITS_DEG["flexion"][finger][segment]
            assert low - SLACK <= angle <= high + SLACK, (finger, segment)
    for finger, angle in zip(FINGERS[1:], pose.spread, strict=True):
        low, high = LIMITS_DEG["abduction"][finger]["proximal"]
        assert low - SLACK <= angle <= high + SLACK, finger
    low, high = LIMITS_DEG["flexion"]["little"]["metacarpal"]
    assert low - SLACK <= pose.arch <= high + SLACK


@every_pose
def test_what_touches_are_bones_of_a_hand_and_what_is_held_fits_into_it(pose: HandPose) -> None:
    bones = hand_bone_names(flat_hand("right"))
    for one, other in pose.touches:
        assert one == "thumb_distal" and other in bones and other != one
    if pose.held is not None:
        assert pose.held.kind in ("ball", "rod") and 0.0 < pose.held.radius < 0.05


@pytest.mark.parametrize("finger", FINGERS[1:])
def test_one_finger_is_bent_alone(finger: str) -> None:
    pose = POSES[POSE_NAMES.index(f"{finger}_bent")]
    bends = {other: sum(getattr(pose, other)) for other in FINGERS[1:]}
    assert bends.pop(finger) > 10.0 * max(bends.values()) and len(set(bends.values())) == 1

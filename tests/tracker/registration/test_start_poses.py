"""Start poses: each sets what it names and nothing else, within what hands can do."""

import numpy as np
import pytest

from tracker.model.blend_limits import CHAINS, blend_limits
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.start_poses import (
    CURLS,
    FOLDED,
    START_POSES,
    STRAIGHT,
    THUMBS,
    curl_finger,
    make_start_pose,
    turn_thumb,
)


@pytest.fixture(scope="module")
def limits():
    return blend_limits(untrained_hand())


@pytest.mark.parametrize("finger", ["index", "middle", "ring", "little"])
def test_a_curled_finger_bends_as_said_and_the_others_stay(limits, finger):
    pose = 0.1 * np.random.default_rng(0).normal(size=(16, 3))
    curled = curl_finger(limits, pose, finger, FOLDED)
    first = CHAINS[finger]
    angles = limits.angles(curled)[first - 1 : first + 2, 0]
    assert np.degrees(angles) == pytest.approx(FOLDED, abs=1e-9)
    others = [bone for bone in range(16) if not first <= bone < first + 3]
    assert (curled[others] == pose[others]).all()


def test_a_turned_thumb_leaves_the_fingers(limits):
    pose = 0.1 * np.random.default_rng(1).normal(size=(16, 3))
    turned = turn_thumb(limits, pose, THUMBS[2])
    first = CHAINS["thumb"]
    assert (turned[:first] == pose[:first]).all()
    angles = np.degrees(limits.angles(turned)[first - 1 : first + 2])
    assert angles[0, :2] == pytest.approx(THUMBS[2][:2]) and angles[1:, 0] == pytest.approx(THUMBS[2][2:])


def test_start_poses_differ_and_all_lie_within_the_limits_of_a_hand(limits):
    poses = [make_start_pose(limits, number) for number in range(len(START_POSES))]
    tips = untrained_hand().tips
    places = [untrained_hand().pose_at(pose).vertices[tips] for pose in poses]
    for number, pose in enumerate(poses):
        assert np.degrees(np.abs(limits.clamped(pose) - pose)).max() < 12.0
        for other in range(number):
            assert np.linalg.norm(places[number] - places[other], axis=1).max() > 0.01


def test_a_folded_finger_ends_nearer_to_the_wrist_than_a_straight_one(limits):
    hand, pose = untrained_hand(), make_start_pose(limits, 0)
    for number, finger in enumerate(("index", "middle", "ring", "little"), 1):
        away = []
        for curl in (STRAIGHT, FOLDED):
            posed = hand.pose_at(curl_finger(limits, pose, finger, curl))
            away.append(np.linalg.norm(posed.vertices[hand.tips[number]] - posed.joints[0]))
        assert away[1] < 0.75 * away[0]
    assert STRAIGHT in CURLS and FOLDED in CURLS

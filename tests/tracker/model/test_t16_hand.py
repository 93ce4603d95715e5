"""Which T16 models are hands: their bones by name, of one side, every finger whole."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.hand_parts import finger_segments
from tracker.model.joints import FINGERS
from tracker.model.t16_hand import FINGER_NUMBERS, find_hand


def names(side: str = "R") -> tuple[str, ...]:
    """As the authors' SKEL files have them: the forearm, then little to thumb, palm first."""
    parts = {finger: ("Hand", "0", "1", "2")[-len(finger_segments(finger)) :] for finger in FINGERS}
    bones = (f"{side}Fing.{n}_{part}" for n, finger in enumerate(FINGER_NUMBERS) for part in parts[finger])
    return ("Root", f"Lower Arm.{side}", *bones)


@pytest.mark.parametrize(("letter", "side"), [("R", "right"), ("L", "left")])
def test_a_hand_is_known_by_its_bones(letter: str, side: str) -> None:
    hand = find_hand(names(letter))
    assert hand is not None and (hand.side, hand.wrist) == (side, 1)
    assert {finger: len(bones) for finger, bones in hand.fingers.items()} == {
        finger: len(finger_segments(finger)) for finger in FINGERS
    }
    every = [bone for finger in reversed(FINGERS) for bone in hand.fingers[finger]]
    assert every == list(range(2, len(names()))), "palm first, the little finger first"


def test_what_lacks_a_bone_or_is_of_both_sides_is_no_hand() -> None:
    whole = names()
    for bone in range(2, len(whole)):
        assert find_hand(whole[:bone] + whole[bone + 1 :]) is None, whole[bone]
        assert find_hand((*whole[:bone], whole[bone].replace("R", "L"), *whole[bone + 1 :])) is None, whole[bone]
    assert find_hand(("ball",)) is None and find_hand(()) is None


def test_without_a_forearm_the_first_bone_is_the_wrist() -> None:
    hand = find_hand(("Palm", *names()[2:]))
    assert hand is not None and hand.wrist == 0


def test_tips_come_from_the_voi_file_or_lie_farthest_along_the_last_bone() -> None:
    hand = find_hand(names())
    assert hand is not None
    joints = np.zeros((len(names()), 3))
    vertices, weights = [], []
    for number, finger in enumerate(FINGERS):
        for step, bone in enumerate(hand.fingers[finger]):
            joints[bone] = [step, number, 0.0]
        for reach in (0.5, 1.0, 0.7):  # the middle one of three on the last bone is the tip
            vertices.append([len(hand.fingers[finger]) + reach, number, 0.0])
            weights.append(np.eye(len(joints))[hand.fingers[finger][-1]])
    tips = hand.find_tips(np.array(vertices), np.array(weights), joints, None)
    assert tips.tolist() == [1, 4, 7, 10, 13]
    voi = np.arange(15).reshape(3, 5)
    told = hand.find_tips(np.array(vertices), np.array(weights), joints, voi)
    assert told.tolist() == [4, 3, 2, 1, 0], "a row of the file goes from the little finger to the thumb"

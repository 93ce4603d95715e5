"""Landmarks of a hand from its bones, weights and tips."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.default_hand import default_hand
from tracker.model.hand_parts import FINGERTIP_SHARE, find_hand_parts, find_tip, finger_segments
from tracker.model.joints import FINGERS, HAND_JOINTS


def comb(with_metacarpals: bool) -> dict:
    """A hand whose fingers are rows of vertices along x, eleven to a bone of 1 m; bone 0 is the wrist."""
    vertices, weights, joints, bones, tips = [[-1.0, 0.0, 0.0]], [0], [[-1.0, 0.0, 0.0]], {}, []
    for number, finger in enumerate(FINGERS):
        count = 3 if finger == "thumb" or not with_metacarpals else 4
        bones[finger] = tuple(range(len(joints), len(joints) + count))
        for step in range(count):
            joints.append([step, number, 0.0])
            for share in np.linspace(0.0, 1.0, 11):
                vertices.append([step + share, number, 0.0])
                weights.append(len(joints) - 1)
        tips.append(len(vertices) - 1)
    return {
        "side": "right",
        "vertices": np.array(vertices, dtype=float),
        "skinning_weights": np.eye(len(joints))[weights],
        "joints": np.array(joints, dtype=float),
        "wrist": 0,
        "finger_bones": bones,
        "tips": np.array(tips),
    }


def test_a_thumb_has_three_bones_and_a_finger_four_palm_first() -> None:
    assert finger_segments("thumb") == ("metacarpal", "proximal", "distal")
    assert {finger_segments(finger) for finger in FINGERS[1:]} == {("metacarpal", "proximal", "middle", "distal")}


@pytest.mark.parametrize("with_metacarpals", [True, False])
def test_joints_are_the_three_last_bones_of_each_finger_and_its_tip(with_metacarpals: bool) -> None:
    hand = comb(with_metacarpals)
    parts = find_hand_parts(**hand)
    assert parts.joint_bones[0] == hand["wrist"]
    for number, finger in enumerate(FINGERS):
        base = HAND_JOINTS.index(f"{finger}_{'cmc' if finger == 'thumb' else 'mcp'}")
        assert parts.joint_bones[base : base + 4].tolist() == [*hand["finger_bones"][finger][-3:], -1]
        assert parts.joint_vertices[base : base + 4].tolist() == [-1, -1, -1, hand["tips"][number]]
    assert np.all((parts.joint_bones >= 0) != (parts.joint_vertices >= 0)), "each is a bone's or a vertex"


@pytest.mark.parametrize("with_metacarpals", [True, False])
def test_parts_are_the_vertices_that_follow_a_bone_most_each_in_one_part(with_metacarpals: bool) -> None:
    hand = comb(with_metacarpals)
    parts = find_hand_parts(**hand).finger_parts
    assert ("index_metacarpal" in parts) == with_metacarpals
    assert all(len(ids) == (1 if name == "wrist" else 11) for name, ids in parts.items())
    together = np.concatenate(list(parts.values()))
    assert sorted(together) == list(range(len(hand["vertices"])))
    assert set(hand["skinning_weights"][parts["little_distal"]].argmax(axis=1)) == {hand["finger_bones"]["little"][-1]}


def test_a_fingertip_is_the_outer_part_of_the_last_bone_and_holds_its_tip() -> None:
    hand = comb(True)
    parts = find_hand_parts(**hand)
    for number, finger in enumerate(FINGERS):
        last = hand["finger_bones"][finger][-1]
        along = hand["vertices"][parts.fingertips[number], 0] - hand["joints"][last, 0]
        np.testing.assert_allclose(along, [0.6, 0.7, 0.8, 0.9, 1.0])
        assert along.min() >= FINGERTIP_SHARE
        assert hand["tips"][number] in parts.fingertips[number]


def test_a_tip_of_another_bone_is_a_fingertip_all_the_same() -> None:
    hand = comb(True)
    hand["tips"][1] = 0
    assert 0 in find_hand_parts(**hand).fingertips[1]


def test_a_tip_is_far_along_its_bone_and_near_its_line() -> None:
    chain = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]])
    vertices = np.array([[1.5, 0, 0], [1.9, 0.0, 0.1], [2.0, 0.4, 0.0], [3.0, 0.0, 0.0], [-2.0, 0.0, 0.0]])
    assert find_tip(vertices, np.array([1.0, 1.0, 1.0, 0.4, 1.0]), chain) == 1, "the farthest does not follow the bone"
    assert find_tip(vertices, np.array([1.0, 1.0, 1.0, 0.6, 1.0]), chain) == 3


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_tips_of_the_default_hand_are_found_again_from_its_joints_alone(side: str) -> None:
    model = default_hand(side)
    assert model.hand is not None
    for base, finger in zip(range(1, 21, 4), FINGERS, strict=True):
        tip, bones = model.hand.joint_vertices[base + 3], model.hand.joint_bones[base : base + 3]
        chain = np.array([*model.skeleton.joints_rest[bones], model.vertices[tip]])
        found = find_tip(model.vertices, model.skinning_weights[:, bones[-1]], chain)
        assert np.linalg.norm(model.vertices[found] - model.vertices[tip]) < 0.003, finger

"""A hand changes in the part that a direction names, and nowhere else."""

import numpy as np
import pytest

from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.local_directions import LENGTH, local_directions, mark_directions
from tracker.model.scene import Scene


def landmarks_of(hand):
    return Scene((hand,)).pose_at(np.zeros(hand.num_dofs)).landmarks(0)


def bone_lengths(hand):
    """(5, 3) of each finger's three bones."""
    fingers = landmarks_of(hand)[1:].reshape(5, 4, 3)
    return np.linalg.norm(np.diff(fingers, axis=1), axis=2)


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize(("finger", "segment", "number"), [("index", "middle", 1), ("thumb", "proximal", 1)])
def test_a_length_lengthens_its_bone_alone(side, finger, segment, number):
    hand = default_hand(side)
    directions = local_directions(hand)
    values = np.zeros(len(directions.names))
    values[directions.names.index(f"{finger}_{segment}_length")] = 1.0
    ratio = bone_lengths(directions.apply(hand, values)) / bone_lengths(hand)
    expected = np.ones((5, 3))
    expected[FINGERS.index(finger), number] = 1.0 + LENGTH
    np.testing.assert_allclose(ratio, expected, atol=1e-9)


def test_a_joint_turns_elsewhere_in_the_same_flesh():
    hand = default_hand("right")
    directions = local_directions(hand)
    values = np.zeros(len(directions.names))
    values[directions.names.index("index_middle_turns_x")] = 1.0
    moved = directions.apply(hand, values)
    np.testing.assert_array_equal(moved.vertices, hand.vertices)
    apart = np.linalg.norm(landmarks_of(moved) - landmarks_of(hand), axis=1)
    assert np.flatnonzero(apart > 1e-9).tolist() == [HAND_JOINTS.index("index_pip")]


def test_marks_move_no_bone_and_no_skin():
    hand = default_hand("right")
    directions = mark_directions(hand, np.full(21, 0.004), np.full(21, 0.002))
    moved = directions.apply(hand, np.ones(len(directions.names)))
    np.testing.assert_array_equal(moved.vertices, hand.vertices)
    np.testing.assert_array_equal(moved.skeleton.joints_rest, hand.skeleton.joints_rest)
    assert np.linalg.norm(landmarks_of(moved) - landmarks_of(hand), axis=1).min() > 1e-3  # m

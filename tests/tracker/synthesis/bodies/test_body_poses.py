"""Generated people stand as people may, move without jumps, and have both sides alike."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.model.body_hands import body_hand
from tracker.model.mano_files import BODY_JOINTS
from tracker.synthesis.bodies.body_poses import RANGES_DEG, a_pose, draw_hand, draw_pose, is_entangled
from tracker.synthesis.bodies.hand_poses import MIRRORED
from tracker.synthesis.bodies.person import make_person

PERSON = make_person(2)
seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize("seed", range(4))
def test_no_limb_of_a_drawn_pose_is_in_another_and_every_joint_keeps_its_range(seed) -> None:
    pose = draw_pose(PERSON, np.random.default_rng(seed))
    assert not is_entangled(PERSON, pose)
    assert pose[0, 0] == pose[0, 2] == 0.0, "upright"
    for name, ranges in RANGES_DEG.items():
        turn = Rotation.from_rotvec(pose[BODY_JOINTS.index(name)]).as_euler("xyz", degrees=True)
        same = (turn * [1, -1, 1] + 360.0) % 360.0 - 180.0  # the same turn by its other three angles
        low, high = np.array(ranges).T
        assert any((each > low - 1e-6).all() and (each < high + 1e-6).all() for each in (turn, same)), name


def test_without_wildness_everybody_stands_in_the_a_pose_with_hands_of_their_own() -> None:
    pose = draw_pose(PERSON, np.random.default_rng(1), wildness=0.0)
    assert np.allclose(pose[1:22], a_pose()[1:22], atol=1e-12)
    assert np.abs(pose[22:]).max() > 0.1


def test_the_a_pose_is_its_own_mirror_image_and_its_arms_hang() -> None:
    vertices, joints = PERSON.posed(a_pose(), np.zeros(3))
    for name in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle"):
        left, right = (joints[BODY_JOINTS.index(f"{side}_{name}")] for side in ("left", "right"))
        assert left * MIRROR == pytest.approx(right, abs=0.01), name
    wrist, shoulder = (joints[BODY_JOINTS.index(f"left_{name}")] for name in ("wrist", "shoulder"))
    assert wrist[1] < shoulder[1] - 0.25 and vertices.shape == PERSON.rest.shape


MIRROR = np.array([-1.0, 1.0, 1.0])


@settings(max_examples=15, deadline=None)
@given(seeds)
def test_a_left_hand_is_drawn_as_the_mirror_image_of_a_right_one(seed) -> None:
    right, left = (draw_hand(side, np.random.default_rng(seed)) for side in ("right", "left"))
    assert np.array_equal(left, right * MIRRORED) and right.shape == (15, 3)


def test_fingers_of_both_hands_are_where_the_model_has_them() -> None:
    assert {side: body_hand(PERSON.model, side).wrist for side in ("left", "right")} == {"left": 20, "right": 21}

"""Generated people stand as people may, move without jumps, and have both sides alike."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.model.body_hands import body_hand
from tracker.model.mano_files import BODY_JOINTS
from tracker.synthesis.bodies.body_poses import RANGES_DEG, a_pose, draw_hand, draw_pose, is_entangled
from tracker.synthesis.bodies.hand_poses import MIRRORED
from tracker.synthesis.bodies.moving import _interpolate
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


@settings(max_examples=15, deadline=None)
@given(seeds, st.floats(0.5, 2.0))
def test_a_person_who_is_moved_and_turned_keeps_every_distance(seed, metres) -> None:
    rng = np.random.default_rng(seed)
    pose = a_pose()
    still, _ = PERSON.posed(pose, np.zeros(3))
    pose[0] = Rotation.from_quat(rng.standard_normal(4)).as_rotvec()
    moved, _ = PERSON.posed(pose, metres * rng.standard_normal(3))
    few = rng.integers(0, len(still), 30)
    lengths = [np.linalg.norm(v[few][:, None] - v[few], axis=2) for v in (still, moved)]
    assert np.allclose(*lengths, atol=1e-9)


@settings(max_examples=20, deadline=None)
@given(seeds, st.lists(st.integers(2, 20), min_size=1, max_size=3))
def test_a_motion_is_at_each_key_in_time_rests_there_and_never_turns_farther_than_to_the_next(seed, spans) -> None:
    rng = np.random.default_rng(seed)
    times = [0, *np.cumsum(spans).tolist()]
    keys = rng.uniform(-1.0, 1.0, (len(times), 2, 3))
    frames = times[-1] + 1
    moved = _interpolate(keys, times, frames)
    turns = Rotation.from_rotvec(moved.reshape(-1, 3))
    wanted = Rotation.from_rotvec(keys.reshape(-1, 3))
    at_keys = Rotation.from_rotvec(moved[times].reshape(-1, 3))
    assert (at_keys.inv() * wanted).magnitude().max() < 1e-6
    for pair, (begin, end) in enumerate(pairwise(times)):
        whole = (wanted[2 * pair].inv() * wanted[2 * pair + 2]).magnitude()
        steps = [(turns[2 * t].inv() * turns[2 * t + 2]).magnitude() for t in range(begin, end)]
        assert np.isclose(sum(steps), whole, atol=1e-6), "the shortest way"
        if len(steps) > 4 and whole > 0.1:
            assert max(steps[0], steps[-1]) < 0.7 * max(steps), "slow at both ends"


def test_fingers_of_both_hands_are_where_the_model_has_them() -> None:
    assert {side: body_hand(PERSON.model, side).wrist for side in ("left", "right")} == {"left": 20, "right": 21}

"""People who move: still at first, at rest at each key, on the floor, and without hands when those are fastest."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.model.body_hands import body_hand
from tracker.synthesis.bodies.body_poses import a_pose
from tracker.synthesis.bodies.generate import BODY_SCANNER, SIDES
from tracker.synthesis.bodies.hand_poses import MIRRORED
from tracker.synthesis.bodies.moving import MovingOptions, MovingPerson, _interpolate, make_motion

seeds = st.integers(0, 2**32 - 1)
SCANNER = replace(BODY_SCANNER, num_points=8000, views=6, pixels=400)
OPTIONS = MovingOptions(still=6, body_frames=20, hand_frames=10, missing=0.3, spell=(3, 5))


@pytest.fixture(scope="module")
def moving() -> MovingPerson:
    return make_motion(5, 40, options=OPTIONS)


def test_a_motion_begins_still_moves_smoothly_and_loses_hands_for_a_fifth_of_it() -> None:
    moving = make_motion(2, 60, options=MovingOptions(still=8))
    assert np.abs(np.diff(moving.poses[:8], axis=0)).max() < 1e-9
    vertices = np.array([moving.person.posed(moving.poses[t], moving.translations[t])[1] for t in range(60)])
    assert np.abs(np.diff(vertices, axis=0)).max() < 0.12, "m a frame: 7 m/s"
    assert not moving.is_missing[:8].any() and (np.abs(moving.is_missing.mean(axis=0) - 0.25) < 0.12).all()
    seen = moving.scan(0, SCANNER)
    assert np.array_equal(seen.scan.points, moving.scan(0, SCANNER).scan.points)


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


def test_the_same_arguments_make_the_same_motion_and_another_seed_another_one(moving) -> None:
    again, other = make_motion(5, 40, options=OPTIONS), make_motion(5, 40, seed=1, options=OPTIONS)
    for name in ("poses", "translations", "is_missing"):
        np.testing.assert_array_equal(getattr(again, name), getattr(moving, name))
    assert len(moving) == len(other) == 40 and other.person is moving.person
    assert np.abs(other.poses - moving.poses).max() > 0.1


def test_the_soles_are_on_the_floor_in_every_frame(moving) -> None:
    for t in range(0, 40, 7):
        vertices, _ = moving.person.posed(moving.poses[t], moving.translations[t])
        assert vertices[:, 1].min() == pytest.approx(0.0, abs=1e-12)
    assert not moving.translations[:, [0, 2]].any(), "nobody walks"


def test_a_person_stands_in_the_a_pose_first_turned_some_way_with_both_hands_flat_and_alike(moving) -> None:
    first = moving.poses[0]
    np.testing.assert_allclose(first[1:22], a_pose()[1:22], atol=1e-9)
    left, right = (first[body_hand(moving.person.model, side).fingers] for side in SIDES)
    np.testing.assert_allclose(left, right * MIRRORED, atol=1e-9)
    assert np.abs(moving.poses[OPTIONS.still + 10] - first).max() > 0.1


def test_fingers_move_by_themselves_and_come_to_rest_at_their_own_keys(moving) -> None:
    fingers = body_hand(moving.person.model, "right").fingers
    steps = np.abs(np.diff(moving.poses, axis=0))
    of_hand, of_body = steps[:, fingers].max(axis=(1, 2)), steps[:, 1:22].max(axis=(1, 2))
    middle = OPTIONS.still + OPTIONS.hand_frames
    assert of_hand[middle - 1 : middle + 1].max() < 0.3 * of_hand[OPTIONS.still : middle].max()
    assert of_body[middle - 1 : middle + 1].min() > 0.5 * of_body.max(), "the body is half way to its next pose there"


def test_gaps_are_as_many_and_as_long_as_asked_and_never_while_the_person_stands_still(moving) -> None:
    assert not moving.is_missing[: OPTIONS.still].any()
    assert (moving.is_missing.mean(axis=0) >= OPTIONS.missing).all()
    for column in moving.is_missing.T:
        ends = np.flatnonzero(np.diff(np.r_[False, column, False].astype(int)))
        for begin, end in ends.reshape(-1, 2):
            assert OPTIONS.spell[0] <= end - begin or begin == OPTIONS.still or end == 40
    never = make_motion(5, 40, options=replace(OPTIONS, missing=0.0))
    assert not never.is_missing.any()
    np.testing.assert_array_equal(never.poses, moving.poses)


def test_a_motion_shorter_than_its_still_beginning_does_not_move() -> None:
    still = make_motion(5, 4, options=OPTIONS)
    assert len(still) == 4 and not still.is_missing.any()
    np.testing.assert_allclose(still.poses, np.tile(still.poses[0], (4, 1, 1)), atol=1e-12)

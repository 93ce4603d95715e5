"""Generated people: always the same by their number, and skinned so that limbs keep their volume."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.model.body_hands import body_hand
from tracker.model.body_model import body_model
from tracker.model.decimation import compute_volume
from tracker.model.mano_files import BODY_JOINTS
from tracker.synthesis.bodies.body_poses import a_pose
from tracker.synthesis.bodies.person import Person, hand_vertices, make_person

PERSON = make_person(2)
seeds = st.integers(0, 2**32 - 1)


def test_people_differ_and_their_surface_is_outside_the_shape_space() -> None:
    person = make_person(3)
    directions = person.model.shape_directions.reshape(-1, person.model.num_shape)
    apart = (person.rest - person.model.template).ravel()
    left = apart - directions @ np.linalg.lstsq(directions, apart, rcond=None)[0]
    assert 1e-3 < np.sqrt(np.mean(np.sum(left.reshape(-1, 3) ** 2, axis=1))) < 3e-3
    assert np.abs(make_person(4).rest - person.rest).max() > 0.01


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


def test_a_number_is_one_person_of_a_sex_and_both_sexes_occur() -> None:
    make_person.cache_clear()
    again = make_person(2)
    np.testing.assert_array_equal(again.rest, PERSON.rest)
    assert (again.number, again.sex) == (2, PERSON.sex)
    people = [make_person(number) for number in range(6)]
    assert {person.sex for person in people} == {"male", "female"}
    assert all(person.model is body_model(person.sex) for person in people)


def test_what_no_shape_space_holds_is_much_less_on_the_hands() -> None:
    directions = PERSON.model.shape_directions.reshape(-1, PERSON.model.num_shape)
    apart = (PERSON.rest - PERSON.model.template).ravel()
    left = (apart - directions @ np.linalg.lstsq(directions, apart, rcond=None)[0]).reshape(-1, 3)
    sizes = np.linalg.norm(left, axis=1)
    hands = np.concatenate(list(hand_vertices(PERSON.model).values()))
    assert np.median(sizes[hands]) < 0.5 * np.median(np.delete(sizes, hands))


def linear(person: Person, pose: np.ndarray) -> np.ndarray:
    """Vertices by linear blend skinning alone."""
    return person.model.pose_at(pose, rest=person.rest).vertices


def test_hands_are_those_of_the_model_and_the_rest_is_not() -> None:
    pose = a_pose()
    pose[22:] = 0.4 * np.random.default_rng(0).normal(size=(30, 3))
    pose[BODY_JOINTS.index("left_elbow"), 1] -= 1.5
    vertices, joints = PERSON.posed(pose, np.zeros(3))
    plain = linear(PERSON, pose)
    model = PERSON.model
    hands = [body_hand(model, side) for side in ("left", "right")]
    own = np.concatenate([[hand.wrist, *hand.fingers] for hand in hands])
    of_hands = model.skinning_weights[:, own].sum(axis=1) > 1.0 - 1e-9
    np.testing.assert_allclose(vertices[of_hands], plain[of_hands], atol=1e-9)
    assert np.abs(vertices - plain).max() > 0.001 and of_hands.sum() > 1000
    np.testing.assert_array_equal(joints, model.pose_at(pose, rest=PERSON.rest).joints)


@pytest.mark.parametrize("joint", ["left_elbow", "right_knee"])
def test_a_twisted_limb_keeps_more_of_its_volume_than_by_linear_blending(joint: str) -> None:
    place = BODY_JOINTS.index(joint)
    rest = PERSON.model.joints_of(PERSON.rest)
    child = int(np.flatnonzero(PERSON.model.parents == place)[0])
    along = (rest[child] - rest[place]) / np.linalg.norm(rest[child] - rest[place])
    pose = np.zeros((52, 3))
    straight = compute_volume(PERSON.posed(pose, np.zeros(3))[0], PERSON.model.faces)
    pose[place] = np.radians(120.0) * along
    surfaces = PERSON.posed(pose, np.zeros(3))[0], linear(PERSON, pose)
    rounded, plain = (compute_volume(vertices, PERSON.model.faces) for vertices in surfaces)
    assert abs(rounded - straight) < 0.5 * abs(plain - straight)


def test_a_translation_moves_vertices_and_joints_alike() -> None:
    away = np.array([0.3, -0.2, 0.5])
    here, there = PERSON.posed(a_pose(), np.zeros(3)), PERSON.posed(a_pose(), away)
    for one, other in zip(here, there, strict=True):
        np.testing.assert_allclose(other, one + away, atol=1e-12)


def test_the_hands_of_a_person_are_782_vertices_each_which_lie_on_their_sides() -> None:
    for side, ids in hand_vertices(PERSON.model).items():
        assert len(ids) == len(set(ids)) == 782
        assert (np.sign(PERSON.rest[ids, 0]) == (1.0 if side == "left" else -1.0)).all()

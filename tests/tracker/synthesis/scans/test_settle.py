"""Settled poses keep their joints' limits, touch what they should, and change nothing that was possible already."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.errors import TrackerError
from tracker.synthesis.scans.angles import clip_to_limits, pose_angles, rest_angle, vary
from tracker.synthesis.scans.arrange import arrange
from tracker.synthesis.scans.deform import place_bones
from tracker.synthesis.scans.pose_list import POSE_NAMES, POSES
from tracker.synthesis.scans.settle import GIVE, load_balls, settle
from tracker.synthesis.scans.subject import BONES, load_subject

SUBJECT = load_subject(4)
LOWER = np.array([dof.lower for dof in SUBJECT.dofs])
UPPER = np.array([dof.upper for dof in SUBJECT.dofs])


def overlap(angles: np.ndarray) -> np.ndarray:
    """(P,) m, by how much each pair of balls is too near in a pose."""
    balls = load_balls(SUBJECT.number)
    Ts = place_bones(SUBJECT, angles)[balls.bones]
    placed = np.einsum("nij,nj->ni", Ts[:, :, :3], balls.centers) + Ts[:, :, 3]
    first, second = balls.pairs.T
    gap = np.linalg.norm(placed[first] - placed[second], axis=1)
    return balls.radii[first] + balls.radii[second] - gap - balls.slack


def test_balls_lie_inside_the_hand_and_at_rest_none_is_too_near() -> None:
    balls = load_balls(SUBJECT.number)
    nearest = np.linalg.norm(SUBJECT.vertices[:, None] - balls.centers, axis=2).min(axis=0)
    assert (balls.radii <= nearest + 1e-12).all() and balls.radii.min() > 2e-3
    assert overlap(np.zeros(len(SUBJECT.dofs))).max() <= -GIVE + 1e-12
    assert set(balls.pads) == {name for name in BONES if name != "wrist"}


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_settled_angles_are_within_every_limit_and_overlap_less_than_those_that_were_wanted(seed) -> None:
    wanted = np.random.default_rng(seed).uniform(LOWER, UPPER)
    found = settle(SUBJECT, wanted, ())
    assert (found >= LOWER - 1e-9).all() and (found <= UPPER + 1e-9).all()
    assert np.maximum(overlap(found), 0.0).sum() <= np.maximum(overlap(wanted), 0.0).sum() + 1e-6


def test_a_pose_without_overlaps_stays_as_it_is() -> None:
    flat = pose_angles(SUBJECT, POSES[POSE_NAMES.index("flat_spread")])
    assert overlap(flat).max() <= 0.0
    assert np.allclose(settle(SUBJECT, clip_to_limits(SUBJECT, flat), ()), clip_to_limits(SUBJECT, flat), atol=1e-9)


@pytest.mark.parametrize("name", [pose.name for pose in POSES if pose.touches])
def test_pads_that_should_touch_do_within_two_millimetres(name) -> None:
    pose = POSES[POSE_NAMES.index(name)]
    wanted = pose_angles(SUBJECT, pose)
    balls = load_balls(SUBJECT.number)

    def gaps(angles: np.ndarray) -> list[float]:
        Ts = place_bones(SUBJECT, angles)[balls.bones]
        placed = np.einsum("nij,nj->ni", Ts[:, :, :3], balls.centers) + Ts[:, :, 3]
        pairs = [(balls.pads[a], balls.pads[b]) for a, b in pose.touches]
        return [float(np.linalg.norm(placed[i] - placed[j]) - balls.radii[i] - balls.radii[j]) for i, j in pairs]

    assert max(np.abs(gaps(settle(SUBJECT, wanted, pose.touches)))) < 2e-3, "m"


@pytest.mark.parametrize("name", POSE_NAMES[::6])
def test_a_listed_pose_bends_each_finger_as_listed_whatever_the_subject_is_like_at_rest(name) -> None:
    pose = POSES[POSE_NAMES.index(name)]
    for number in (1, 9):
        subject = load_subject(number)
        angles = pose_angles(subject, pose)
        for place, dof in enumerate(subject.dofs):
            if dof.finger != "thumb" and dof.segment != "metacarpal" and dof.motion == "flexion":
                listed = getattr(pose, dof.finger)[("proximal", "middle", "distal").index(dof.segment)]
                assert angles[place] + rest_angle(subject, place) == pytest.approx(np.radians(listed))


def test_habits_are_a_subjects_own_and_moments_differ_less_than_people() -> None:
    angles = pose_angles(SUBJECT, POSES[0])
    by_habit = [vary(SUBJECT, angles, np.random.default_rng(k), np.random.default_rng(0)) for k in range(40)]
    by_moment = [vary(SUBJECT, angles, np.random.default_rng(0), np.random.default_rng(k)) for k in range(40)]
    assert np.std(by_habit, axis=0).mean() > 1.2 * np.std(by_moment, axis=0).mean() > 0.0
    for varied in (*by_habit, *by_moment):
        assert (varied >= LOWER).all() and (varied <= UPPER).all()


def test_the_same_arrangement_is_the_same_and_another_side_or_seed_another_moment() -> None:
    (_, name, one), (_, _, same) = (arrange(3, "fist", "right", seed=2) for _ in range(2))
    assert name == "fist" and np.array_equal(one, same)
    for other in (arrange(3, "fist", "left", seed=2), arrange(3, "fist", "right", seed=3), arrange(5, "fist", seed=2)):
        assert not np.array_equal(one, other[2])
    _, _, exact = arrange(3, "fist", is_varied=False)
    assert np.array_equal(exact, arrange(3, "fist", seed=9, is_varied=False)[2])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((1, "fist", "middle"), "'right' or 'left', not 'middle'"),
        ((0, "fist"), "numbered from 1"),
        ((1, np.full(31, np.nan)), "A pose is 31 angles"),
        ((1, "nonsense"), "There is no pose 'nonsense'"),
        ((1, -1), "There is no pose -1"),
    ],
)
def test_what_there_is_not_is_refused_with_what_there_is(arguments, said) -> None:
    with pytest.raises(TrackerError, match=said):
        arrange(*arguments)

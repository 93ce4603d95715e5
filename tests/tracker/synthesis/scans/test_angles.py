"""A listed pose is the same bend of anybody's fingers; people and moments vary it within the limits of the joints."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.synthesis.scans.angles import pose_angles, rest_angle, vary
from tracker.synthesis.scans.pose_list import POSE_NAMES, POSES
from tracker.synthesis.scans.subject import load_subject

SUBJECT = load_subject(4)
LOWER = np.array([dof.lower for dof in SUBJECT.dofs])
UPPER = np.array([dof.upper for dof in SUBJECT.dofs])


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

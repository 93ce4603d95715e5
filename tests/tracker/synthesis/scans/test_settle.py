"""Settled poses keep their joints' limits, touch what they should, and change nothing that was possible already."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.synthesis.scans.angles import clip_to_limits, pose_angles
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

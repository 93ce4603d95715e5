"""Anatomical axes of a blend model bend fingers as anatomy does, for both hands alike."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.model.mirrored_poses import mirror_blend_pose
from tests.tracker.random_blend import random_blend, random_pose
from tracker.model.blend_limits import CHAINS, MOTIONS, blend_chains, blend_limits, turn_jacobian
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.joints import FINGERS
from tracker.model.untrained_hand import untrained_hand


def tip_moves(side: str, finger: str, number: int, motion: str) -> np.ndarray:
    """Where a small positive turn of one joint moves the tip of its finger, along wrist-knuckle, to the thumb, back."""
    model = untrained_hand(side)
    limits = blend_limits(model)
    angles = np.zeros((15, 3))
    angles[CHAINS[finger] - 1 + number, MOTIONS.index(motion)] = 0.2
    tip = model.tips[FINGERS.index(finger)]
    move = model.pose_at(limits.pose_at(angles)).vertices[tip] - model.template[tip]
    return move * ([1.0, 1.0, 1.0] if side == "right" else [1.0, -1.0, 1.0])


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize("finger", ["index", "middle", "ring", "little"])
def test_flexion_bends_towards_the_palm_and_abduction_towards_the_thumb(side, finger):
    for number in range(3):
        bent = tip_moves(side, finger, number, "flexion")
        assert bent[2] < -0.8 * np.linalg.norm(bent[1:]) and bent[2] < -0.002
    spread = tip_moves(side, finger, 0, "abduction")
    assert spread[1] > 0.9 * np.linalg.norm(spread[1:])
    turned = tip_moves(side, finger, 0, "twist")
    assert np.linalg.norm(turned) < 0.5 * np.linalg.norm(spread)


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_flexed_thumb_comes_nearer_to_the_little_finger(side):
    model = untrained_hand(side)
    limits = blend_limits(model)
    angles = np.zeros((15, 3))
    angles[12:, 0] = 0.5
    posed = model.pose_at(limits.pose_at(angles)).vertices
    before = np.linalg.norm(model.template[model.tips[0]] - model.joints_of(model.template)[7])
    assert np.linalg.norm(posed[model.tips[0]] - model.joints_of(model.template)[7]) < before - 0.01


def test_axes_are_square_to_each_other_and_angles_come_back():
    model = random_blend()
    limits = blend_limits(model)
    np.testing.assert_allclose(limits.axes @ limits.axes.swapaxes(1, 2), np.tile(np.eye(3), (15, 1, 1)), atol=1e-12)
    angles = np.random.default_rng(0).standard_normal((15, 3))
    np.testing.assert_allclose(limits.angles(limits.pose_at(angles)), angles, atol=1e-12)


def test_mirrored_hands_share_their_angles_and_limits():
    right = random_blend()
    left = mirror_blend(right)
    pose, _, _ = random_pose(right)
    mine, other = blend_limits(right), blend_limits(left)
    np.testing.assert_allclose(other.angles(mirror_blend_pose(pose)), mine.angles(pose), atol=1e-10)
    for name in ("mean", "deviation", "lower", "upper"):
        np.testing.assert_allclose(getattr(other, name), getattr(mine, name), atol=1e-10)


def test_the_rest_pose_and_the_prior_s_mean_are_within_the_limits():
    limits = blend_limits(untrained_hand())
    assert np.all(limits.lower < 0.0) and np.all(limits.upper > 0.0)
    assert np.all(limits.lower <= limits.mean) and np.all(limits.mean <= limits.upper)
    np.testing.assert_allclose(limits.clamped(limits.pose_at(limits.mean)), limits.pose_at(limits.mean), atol=1e-12)


def test_clamping_brings_every_angle_within_its_limits_and_leaves_the_root():
    limits = blend_limits(untrained_hand())
    pose = np.random.default_rng(0).standard_normal((16, 3)) * 2.0
    clamped = limits.clamped(pose)
    np.testing.assert_array_equal(clamped[0], pose[0])
    angles = limits.angles(clamped)
    assert np.all(angles >= limits.lower - 1e-12) and np.all(angles <= limits.upper + 1e-12)


@pytest.mark.parametrize("size", [1e-6, 0.5, 2.0])
def test_the_jacobian_of_turns_meets_finite_differences_of_retract(size):
    model = untrained_hand()
    pose = np.random.default_rng(1).standard_normal((16, 3))
    pose *= size / np.linalg.norm(pose, axis=1, keepdims=True)
    jacobian = turn_jacobian(pose[1:])
    for axis in range(3):
        step = np.zeros(51)
        step[6 + axis :: 3] = 1e-6
        ahead, behind = (model.retract(pose, np.zeros(0), np.zeros(3), s)[0] for s in (step, -step))
        np.testing.assert_allclose(jacobian[:, :, axis], (ahead - behind)[1:] / 2e-6, atol=1e-6)


def test_chains_follow_the_shape():
    model = untrained_hand()
    longer = np.zeros(model.num_shape)
    longer[model.provenance["shape_names"].split(", ").index("index length")] = 2.0
    before, after = blend_chains(model, np.zeros(model.num_shape)), blend_chains(model, longer)
    lengths = [np.linalg.norm(np.diff(c.fingers["index"], axis=0), axis=1).sum() for c in (before, after)]
    assert lengths[1] == pytest.approx(1.08 * lengths[0], rel=0.01)
    np.testing.assert_allclose(after.fingers["little"], before.fingers["little"], atol=1e-4)

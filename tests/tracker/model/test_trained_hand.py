"""The hand learnt from scans that comes with Handloom."""

import argparse

import numpy as np
import pytest

from tracker.cli.command import parse_hand
from tracker.cli.hands import load_hands
from tracker.model.blend_articulated import articulated_of
from tracker.model.scene import Scene
from tracker.model.trained_hand import DATA, trained_hand
from tracker.model.untrained_hand import untrained_hand


def test_it_is_small_free_and_in_the_order_of_the_untrained_hand():
    hand = trained_hand("right")
    assert DATA.stat().st_size < 1_500_000
    assert hand.provenance["license"] == "CC0-1.0" and "no scan of a person" in hand.provenance["source"]
    assert np.array_equal(hand.faces, untrained_hand("right").faces)
    assert np.linalg.norm(hand.template - untrained_hand("right").template, axis=1).max() < 0.005
    np.testing.assert_allclose(hand.skinning_weights.sum(axis=1), 1.0, atol=1e-12)


def test_its_surface_changes_with_the_pose_and_its_left_hand_is_the_mirror_image():
    right, left = (Scene((articulated_of(trained_hand(side)),)) for side in ("right", "left"))
    assert right.pose_blends is not None
    pose = right.rest_pose()
    pose[6:] = 0.4 * right.upper[6:]
    mirrored = left.pose_at(pose).vertices * [1.0, -1.0, 1.0]
    np.testing.assert_allclose(mirrored, right.pose_at(pose).vertices, atol=1e-9)


def test_the_command_line_takes_it_for_both_hands_or_one():
    both = load_hands([parse_hand("trained")], ("right", "left"))
    assert {side: model.hand.side for side, model in both.items() if model.hand} == {"right": "right", "left": "left"}
    assert all(model.pose_blend is not None for model in both.values())
    one = load_hands([parse_hand("left=trained")], ("right", "left"))
    assert one["right"].pose_blend is None and one["left"].pose_blend is not None
    with pytest.raises(argparse.ArgumentTypeError, match="learnt from scans"):
        parse_hand("untrained")

"""Nails lie on the back of the fingers' ends."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.nails import find_nails
from tracker.model.scene import Scene


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_nail_is_on_the_skin_near_its_fingertip_and_of_a_nails_size(side: str) -> None:
    model = default_hand(side)
    scene = Scene((model,))
    joints = scene.pose_at(scene.rest_pose()).landmarks(0)
    nails = find_nails(model)
    assert tuple(nail.finger for nail in nails) == FINGERS
    for nail in nails:
        np.testing.assert_allclose(nail.shares @ model.vertices[nail.corners], nail.middle, atol=1e-12)
        np.testing.assert_allclose(nail.axes @ nail.axes.T, np.eye(3), atol=1e-9)
        tip = joints[HAND_JOINTS.index(f"{nail.finger}_tip")]
        assert np.linalg.norm(nail.middle - tip) < 0.013
        assert 0.008 < 2 * nail.half_width < 2 * nail.half_length < 0.020


@pytest.mark.parametrize("side", ["right", "left"])
def test_nails_look_out_of_the_back_of_the_hand(side: str) -> None:
    for nail in find_nails(default_hand(side)):
        corners = default_hand(side).vertices[nail.corners]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        assert nail.axes[2] @ normal > 0.8 * np.linalg.norm(normal), nail.finger
        if nail.finger != "thumb":  # which is rolled across the palm
            assert nail.axes[2][2] > 0.7


def test_the_left_hands_nails_are_the_right_hands_mirrored() -> None:
    for right, left in zip(find_nails(default_hand("right")), find_nails(default_hand("left")), strict=True):
        np.testing.assert_allclose(left.middle, right.middle * [1, -1, 1], atol=1e-9)
        assert left.half_width == pytest.approx(right.half_width)


def test_measure_is_one_at_the_edge_and_infinite_on_the_pad() -> None:
    nail = find_nails(default_hand("right"))[1]
    towards, across, out = nail.axes
    points = nail.middle + np.array(
        [np.zeros(3), nail.half_length * towards, -nail.half_width * across, -0.010 * out, -nail.half_length * towards]
    )
    away, along = nail.measure(points)
    np.testing.assert_allclose(away, [0, 1, 1, np.inf, 1], atol=1e-9)
    np.testing.assert_allclose(along, [0, 1, 0, 0, -1], atol=1e-9)

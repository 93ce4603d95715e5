"""What follows from the joints that the networks tell."""

from __future__ import annotations

import numpy as np

from tracker.landmarks import DetectedHand
from tracker.landmarks.detected_hand import BEYOND, TIPS
from tracker.model.joints import HAND_JOINTS


def test_fingers_go_on_straight_beyond_the_fingertips_of_the_networks(rng):
    hand = DetectedHand(rng.uniform(0.0, 200.0, (21, 2)), rng.normal(size=(21, 3)), 0.9, 0.8)
    longer = hand.with_finger_ends()
    is_tip = np.array([name.endswith("tip") for name in HAND_JOINTS])
    np.testing.assert_array_equal(np.flatnonzero(is_tip), TIPS)
    np.testing.assert_array_equal(longer.points[~is_tip], hand.points[~is_tip])
    before = np.flatnonzero(is_tip) - 1
    bones = hand.points[is_tip] - hand.points[before]
    np.testing.assert_allclose(longer.points[is_tip] - hand.points[before], (1.0 + BEYOND) * bones, atol=1e-9)
    np.testing.assert_array_equal(longer.next_square.center, hand.next_square.center)
    assert (longer.presence, longer.right) == (hand.presence, hand.right)

"""A scan brought into another pose is one that a hand can have."""

import numpy as np

from benchmarks.reposed_scans import find_pose, settle
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.hand_state import HandState
from tracker.registration.register import Registrar

LITTLE, THUMB = (9, 4), (15, 0)
"""Last joint, and which of the tips."""


def find_gap(hand: HandState) -> float:
    """Between the middles of the last phalanges of thumb and little finger, where they are nearest, m."""
    posed = hand.posed(untrained_hand())
    shares = np.linspace(0.0, 0.9, 50)[:, None]
    lines = [
        posed.joints[joint] + shares * (posed.vertices[untrained_hand().tips[tip]] - posed.joints[joint])
        for joint, tip in (LITTLE, THUMB)
    ]
    return float(np.linalg.norm(lines[0][:, None] - lines[1], axis=2).min())


def test_fingers_that_would_pass_through_one_another_touch():
    model = untrained_hand()
    rest = HandState(np.zeros((16, 3)), np.zeros(model.num_shape), np.zeros(3))
    pose = find_pose(Registrar(model), 20, "thumb_to_little")
    pose[0] = 0.0
    pose[13:] *= 1.1  # the thumb goes on where it has met the little finger
    settled = settle(model, rest, pose, rest.posed(model).vertices)
    assert find_gap(HandState(pose, rest.shape, rest.translation)) < 1.5e-3
    assert 4e-3 < find_gap(settled) < 12e-3  # near their ends
    assert (settled.pose[1:7] == pose[1:7]).all()

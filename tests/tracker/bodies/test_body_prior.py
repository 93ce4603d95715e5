"""What is thought of bodies before a scan is seen: both sides alike, hinges one way, lowered arms the likeliest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from tests.tracker.bodies.posed_bodies import turned
from tracker.bodies.body_prior import LIMITS_DEG, make_body_prior
from tracker.model.mano_files import BODY_JOINTS

PRIOR = make_body_prior()
poses = arrays(np.float64, (21, 3), elements=st.floats(-1.5, 1.5))


def mirrored(pose: np.ndarray) -> np.ndarray:
    """(21, 3) as in the mirror x = 0: sides change places, turns about y and z their sign."""
    names = BODY_JOINTS[1:]
    other = [name.replace("left", "@").replace("right", "left").replace("@", "right") for name in names]
    return pose[[names.index(name) for name in other]] * np.array([1.0, -1.0, -1.0])


@settings(max_examples=50, deadline=None)
@given(poses)
def test_a_pose_and_its_mirror_image_are_as_likely(pose: np.ndarray) -> None:
    assert np.isclose(PRIOR.cost(pose), PRIOR.cost(mirrored(pose)), rtol=1e-9, atol=1e-9)


@settings(max_examples=50, deadline=None)
@given(poses)
def test_no_pose_is_likelier_than_the_mean_which_keeps_every_limit(pose: np.ndarray) -> None:
    assert PRIOR.cost(PRIOR.mean.reshape(21, 3)) == 0.0 <= PRIOR.cost(pose)


@settings(max_examples=10, deadline=None)
@given(poses)
def test_its_gradient_by_turns_meets_finite_differences(pose: np.ndarray) -> None:
    cost, _, gradient = PRIOR.linearize(pose)
    assert np.isclose(cost, PRIOR.cost(pose))
    delta = 1e-6
    for joint in range(21):
        for axis in range(3):
            turn = np.zeros(3)
            turn[axis] = delta
            changed = [pose.copy(), pose.copy()]
            for sign, other in zip((1.0, -1.0), changed, strict=True):
                other[joint] = (Rotation.from_rotvec(sign * turn) * Rotation.from_rotvec(pose[joint])).as_rotvec()
            slope = (PRIOR.cost(changed[0]) - PRIOR.cost(changed[1])) / (2 * delta)
            assert abs(2.0 * gradient[3 * joint + axis] - slope) < 1e-3 * max(1.0, abs(slope)), (joint, axis)


@pytest.mark.parametrize("name", LIMITS_DEG)
def test_a_hinge_that_bends_the_wrong_way_costs_more_than_one_that_bends_as_far_the_right_way(name: str) -> None:
    axis, low, high = LIMITS_DEG[name]
    right_way = 1.0 if high > -low else -1.0
    middle = PRIOR.mean.reshape(21, 3)[BODY_JOINTS.index(name) - 1, axis]

    def bent(degrees: float) -> float:
        turn = [0.0, 0.0, 0.0]
        turn[axis] = np.degrees(middle) + degrees
        own = PRIOR.mean.reshape(21, 3).copy()
        own[BODY_JOINTS.index(name) - 1] = turned(**{name: turn})[BODY_JOINTS.index(name)]
        return PRIOR.cost(own)

    assert bent(-right_way * 45.0) > 10.0 * bent(right_way * 45.0)

"""Pose and shape from a registered mesh: found again, smoothed by the prior, refused for another topology."""

import numpy as np
import pytest

from tracker.model.blend_limits import blend_limits
from tracker.registration.hand_state import HandState
from tracker.registration.start_poses import make_start_pose
from tracker.registration.vertex_fit import fit_to_vertices


@pytest.mark.parametrize("number", [0, 3, 7])
def test_each_pose_is_found_from_one_nearby_wherever_the_hand_is(fit, number):
    rng = np.random.default_rng(number)
    pose = make_start_pose(blend_limits(fit.model), number)
    pose[0] = rng.normal(size=3)
    truth = HandState(pose, 0.5 * rng.normal(size=fit.model.num_shape), rng.uniform(-1.0, 1.0, 3))
    vertices = truth.posed(fit.model).vertices
    near = np.concatenate([np.zeros((1, 3)), 0.75 * pose[1:]])
    found = fit_to_vertices(fit, HandState(near, np.zeros(fit.model.num_shape), np.zeros(3)), vertices)
    assert np.linalg.norm(found.posed(fit.model).vertices - vertices, axis=1).mean() < 5e-4


def test_a_strong_prior_holds_the_pose_back(fit):
    pose = make_start_pose(blend_limits(fit.model), 3)
    vertices = fit.model.pose_at(pose).vertices
    loose, held = (fit_to_vertices(fit, fit.neutral(), vertices, weight) for weight in (0.05, 1e4))
    assert fit.prior.cost(held.pose[1:]) < 0.5 * fit.prior.cost(loose.pose[1:])


def test_vertices_of_another_topology_leave_the_state(fit):
    state = fit.neutral()
    assert fit_to_vertices(fit, state, np.zeros((10, 3))) is state

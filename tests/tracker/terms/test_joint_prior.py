"""Limits and regularisation are Eq. 17 and Eq. 18 and have their derivatives."""

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.fitting.objective import Objective
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.terms.joint_prior import AnatomicalLimits, Bending, Regularization


def test_limits_are_the_sum_of_exponentials_of_the_paper(rng):
    angles = rng.uniform(-1.0, 1.0, size=8)
    lower, upper = np.full(8, -0.8), np.full(8, 0.8)
    cost, _, _ = AnatomicalLimits().linearize(angles, lower, upper)
    paper = np.sum(np.exp(10 * (lower - angles)) + np.exp(10 * (angles - upper)))
    assert cost == pytest.approx(paper, rel=1e-12)


def test_limits_far_outside_do_not_overflow():
    cost, gradient, curvature = AnatomicalLimits().linearize(np.array([300.0]), np.array([-1.0]), np.array([1.0]))
    assert np.isfinite(cost)
    assert np.isfinite(gradient).all()
    assert np.isfinite(curvature).all()


@pytest.mark.parametrize("angle", [-1.5, -0.79, 0.0, 0.5, 0.85, 1.4])
def test_gradients_agree_with_finite_differences(angle):
    angles, lower, upper = np.array([angle]), np.array([-0.8]), np.array([0.8])
    step = 1e-6
    for linearize in (
        lambda a: AnatomicalLimits().linearize(a, lower, upper),
        lambda a: Regularization().linearize(a, np.array([0.2])),
    ):
        _, gradient, _ = linearize(angles)
        numeric = (linearize(angles + step)[0] - linearize(angles - step)[0]) / (2 * step) / 2  # of half the cost
        assert gradient[0] == pytest.approx(numeric, rel=1e-5, abs=1e-8)


def test_a_chain_that_bends_evenly_costs_nothing_and_a_zigzag_does():
    even, zigzag = np.full(6, 0.3), np.array([0.3, -0.3, 0.3, -0.3, 0.3, -0.3])
    costs = [Bending().linearize(angles[1:], angles[:-1])[0] for angles in (even, zigzag)]
    assert costs[0] == 0.0
    assert costs[1] == pytest.approx(5 * 0.6**2)


def test_bending_has_its_derivative_in_the_objective(rng):
    scene = Scene((tube(bones=6),))
    pose = np.r_[np.zeros(6), rng.normal(scale=0.3, size=scene.num_dofs - 6)]
    objective = Objective({}, AnatomicalLimits(0.0), Regularization(0.0), Bending(1.0))

    def cost(at):
        return objective.linearize(scene.pose_at(at), {}, pose)[2]["bending"]

    JtJ, Jtr, _ = objective.linearize(scene.pose_at(pose), {}, pose)
    for dof, unit in enumerate(np.eye(scene.num_dofs)):
        assert Jtr[dof] == pytest.approx((cost(pose + 1e-5 * unit) - cost(pose - 1e-5 * unit)) / 4e-5, abs=1e-6)
    np.testing.assert_allclose(JtJ, JtJ.T)
    assert np.linalg.eigvalsh(JtJ).min() > -1e-9


def test_only_chains_bend_evenly():
    assert len(Scene((tube(bones=2),)).bends) == 0, "a hinge"
    assert len(Scene((default_hand("right"),)).bends) == 0, "fingers"
    scene = Scene((tube(bones=2), tube(bones=4)))
    bends = scene.bends
    skeleton, first = scene.models[1].skeleton, scene.pose_slices[1].start + 6
    assert len(bends) == len(skeleton.dof_bones) - np.count_nonzero(skeleton.dof_bones == 1)
    for own, before in bends - first:
        assert skeleton.parents[skeleton.dof_bones[own]] == skeleton.dof_bones[before]
        np.testing.assert_allclose(skeleton.dof_axes[own], skeleton.dof_axes[before], atol=1e-12)

"""The sum of the terms: what each adds, whatever else is in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import DrawnScene, drawn_tube
from tests.tracker.toys import tube
from tracker.fitting.objective import Objective, thin_terms
from tracker.model.scene import Scene
from tracker.terms.joint_prior import AnatomicalLimits, Bending, Regularization
from tracker.terms.normal_equations import NormalEquations


@pytest.fixture(scope="module")
def drawn() -> DrawnScene:
    return drawn_tube()


@pytest.fixture
def off(drawn, rng) -> np.ndarray:
    """A pose (D,) near the drawn one."""
    return drawn.disturbed(rng)


def linearize(objective: Objective, drawn: DrawnScene, pose: np.ndarray, previous: np.ndarray | None = None):
    posed = drawn.scene.pose_at(pose)
    residuals = objective.find(posed, drawn.context(posed))
    return objective.linearize(posed, residuals, pose if previous is None else previous)


def test_where_a_scene_was_drawn_no_term_pulls_and_beside_it_every_term_of_depth_costs(drawn, off):
    there, beside = (linearize(Objective(), drawn, pose)[2] for pose in (drawn.pose, off))
    for name in ("model_to_data", "data_to_surface", "silhouette"):
        assert there[name] < 0.05 * beside[name]
    assert there["regularization"] == 0.0 and there["uncovered"] == 0.0


def test_a_step_downhill_lowers_the_cost_of_the_same_correspondences(drawn, off):
    objective = Objective()
    posed = drawn.scene.pose_at(off)
    residuals = objective.find(posed, drawn.context(posed))
    JtJ, Jtr, costs = objective.linearize(posed, residuals, off)
    np.testing.assert_allclose(JtJ, JtJ.T, rtol=1e-9)
    assert np.linalg.eigvalsh(JtJ).min() > -1e-6 * np.abs(JtJ).max()
    step = -np.linalg.solve(JtJ + 1e-6 * np.diag(np.diag(JtJ)) + 1e-9 * np.eye(len(Jtr)), Jtr)
    after = objective.linearize(drawn.scene.pose_at(drawn.scene.retract(off, 0.5 * step)), residuals, off)[2]
    assert sum(after.values()) < sum(costs.values())


def test_the_sum_is_that_of_its_terms_one_by_one(drawn, off):
    free = {"anatomy": AnatomicalLimits(0.0), "regularization": Regularization(0.0), "bending": Bending(0.0)}
    whole = linearize(Objective(**free), drawn, off)
    parts = [linearize(Objective({name: term}, **free), drawn, off) for name, term in Objective().terms.items()]
    np.testing.assert_allclose(sum(part[0] for part in parts), whole[0], rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(sum(part[1] for part in parts), whole[1], rtol=1e-9, atol=1e-6)
    for name, part in zip(Objective().terms, parts, strict=True):
        assert part[2][name] == pytest.approx(whole[2][name])


def test_the_order_of_terms_does_not_matter(drawn, off):
    terms = Objective().terms
    one, other = (linearize(Objective(dict(each)), drawn, off) for each in (terms.items(), reversed(terms.items())))
    np.testing.assert_allclose(one[0], other[0], rtol=1e-9, atol=1e-6)
    assert one[2] == pytest.approx(other[2])


def test_the_pull_to_the_frame_before_grows_with_the_distance_and_has_no_say_over_roots(drawn):
    costs, pulls = [], []
    for angle in (0.0, 0.1, 0.2):
        previous = drawn.pose + np.r_[np.full(6, 0.5), np.full(drawn.scene.num_dofs - 6, angle)]
        _, Jtr, cost = linearize(Objective(anatomy=AnatomicalLimits(0.0)), drawn, drawn.pose, previous)
        costs.append(cost["regularization"])
        pulls.append(Jtr)
    assert costs[0] == 0.0 and costs[2] == pytest.approx(4.0 * costs[1])
    np.testing.assert_allclose(pulls[1][:6], pulls[0][:6])
    assert np.all(pulls[1][6:] < pulls[0][6:]), "downhill is towards the larger angles of before"


def test_priors_weigh_as_many_correspondences_as_there_are_and_one_where_there_is_none(drawn):
    objective = Objective({}, regularization=Regularization(0.5))
    posed = drawn.scene.pose_at(drawn.pose)
    previous = drawn.pose + 0.1
    JtJ, _, costs = objective.complete(NormalEquations.at(posed), {}, previous)
    alone = Regularization(0.5).linearize(drawn.pose[6:], previous[6:])
    assert costs["regularization"] == pytest.approx(0.5 * float(alone[0]))
    many = NormalEquations.at(posed)
    many.count = 40
    assert objective.complete(many, {}, previous)[2]["regularization"] == pytest.approx(40 * costs["regularization"])
    assert np.all(np.diag(JtJ)[6:] > 0) and np.all(JtJ[:6, :6] == 0)


def test_a_chain_that_bends_evenly_costs_nothing_and_its_bends_pull_at_each_other_with_equal_force():
    scene = Scene((tube(4),))
    even, uneven = scene.rest_pose(), scene.rest_pose()
    even[6:] = np.tile([0.3, -0.2], 3)
    uneven[6:8] = (0.3, -0.2)
    objective = Objective({}, AnatomicalLimits(0.0), Regularization(0.0))

    def bend(pose: np.ndarray):
        return objective.complete(NormalEquations.at(scene.pose_at(pose)), {}, pose)

    assert bend(even)[2]["bending"] == pytest.approx(0.0, abs=1e-12)
    JtJ, Jtr, costs = bend(uneven)
    assert costs["bending"] > 0.0
    for axis in (0, 1):
        assert Jtr[6 + axis :: 2].sum() == pytest.approx(0.0, abs=1e-9)
        np.testing.assert_allclose(JtJ[6 + axis :: 2, 6 + axis :: 2].sum(axis=1), 0.0, atol=1e-9)


def test_coarse_terms_are_fewer_matches_of_the_same_and_making_them_leaves_the_objective_as_it_is(drawn, off):
    objective = Objective()
    coarse, posed = objective.coarse(), drawn.scene.pose_at(off)
    assert list(coarse.terms) == list(objective.terms) == list(thin_terms(objective.terms))
    assert replace(coarse, terms=objective.terms) == objective
    counts = []
    for each in (objective, coarse):
        equations = NormalEquations.at(posed)
        for residual in each.find(posed, drawn.context(posed)).values():
            residual.add_to(equations)
        counts.append(equations.count)
    assert 0 < counts[1] < 0.6 * counts[0]


def test_a_wide_objective_still_pulls_at_a_scene_that_is_out_of_the_usual_reach(drawn):
    far = drawn.scene.retract(drawn.pose, np.r_[0.0, 0.0, 0.03, np.zeros(drawn.scene.num_dofs - 3)])
    usual, wide = (linearize(each, drawn, far) for each in (Objective(), Objective.wide(0.05, 2.0)))
    assert wide[1][2] > 0.0, "the way downhill is back towards the camera"
    assert abs(wide[1][2]) > abs(usual[1][2])

"""Every term: exact derivatives, the fast sum equal to the plain one, and a step that lowers its own cost."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.tracker.scenes import drawn_tube
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.geometry import se3
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.data_to_model import DataToModel
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.model_to_data import ModelToData
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.residual import Thinnable
from tracker.terms.silhouette import Silhouette
from tracker.terms.uncovered import Uncovered

TERMS: dict[str, Any] = {name: replace(term, weight=1.0) for name, term in Objective().terms.items()} | {
    "model_to_data_points": ModelToData(to_plane=False),
    "data_to_model_vertices": DataToModel(weight=1.0, at_vertices=True, stride=1),
}
"""Every term of the objective, and other forms of some."""

thin_terms = [term for term in TERMS.values() if isinstance(term, Thinnable)]
every_term = pytest.mark.parametrize("term", TERMS.values(), ids=TERMS.keys())

ELSEWHERE = se3.exp(np.array([0.4, -0.2, 0.7, 0.3, -0.8, 0.5]))
"""A camera that is not the world's origin."""


@every_term
@pytest.mark.parametrize("T_world_camera", [np.eye(4), ELSEWHERE], ids=["at the origin", "elsewhere"])
def test_jacobian_agrees_with_finite_differences(term, T_world_camera, rng):
    drawn = drawn_tube(T_world_camera)
    pose = drawn.disturbed(rng)
    posed = drawn.scene.pose_at(pose)
    residual = term.find(posed, drawn.context(posed))
    assert residual.count > 3
    block = residual.linearize(posed)
    step = 1e-6
    for dof in range(drawn.scene.num_dofs):
        delta = np.zeros(drawn.scene.num_dofs)
        delta[dof] = step
        ahead = residual.linearize(drawn.scene.pose_at(drawn.scene.retract(pose, delta))).residual
        behind = residual.linearize(drawn.scene.pose_at(drawn.scene.retract(pose, -delta))).residual
        np.testing.assert_allclose(block.jacobian[:, dof], (ahead - behind) / (2 * step), atol=1e-4)  # mm per rad or m


@every_term
def test_fast_sum_equals_plain_jacobian(term, rng):
    drawn = drawn_tube(ELSEWHERE)
    posed = drawn.scene.pose_at(drawn.disturbed(rng))
    residual = term.find(posed, drawn.context(posed))
    block = residual.linearize(posed)
    equations = NormalEquations.at(posed)
    residual.add_to(equations)
    JtJ, Jtr = equations.assemble()
    weighted = block.jacobian * block.weights[:, None]
    np.testing.assert_allclose(JtJ, weighted.T @ block.jacobian, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(Jtr, weighted.T @ block.residual, rtol=1e-9, atol=1e-6)
    assert equations.cost == pytest.approx(block.cost, rel=1e-9)
    assert equations.count == residual.count


@every_term
def test_one_step_lowers_its_own_cost(term, rng):
    drawn = drawn_tube()
    pose = drawn.disturbed(rng)
    posed = drawn.scene.pose_at(pose)
    residual = term.find(posed, drawn.context(posed))
    equations = NormalEquations.at(posed)
    residual.add_to(equations)
    step = compute_damped_step(*equations.assemble(), 0.1, np.full(drawn.scene.num_dofs, 0.2))
    after = residual.linearize(drawn.scene.pose_at(drawn.scene.retract(pose, step)))
    assert after.cost < residual.linearize(posed).cost


@every_term
def test_cost_is_next_to_nothing_at_the_true_pose(term):
    drawn = drawn_tube()
    posed = drawn.scene.pose_at(drawn.pose)
    residual = term.find(posed, drawn.context(posed))
    if residual.count:
        block = residual.linearize(posed)
        weighted = block.weights * block.residual**2
        assert weighted.sum() / block.weights.sum() < 1.0**2  # mm; pixels are 1 mm apart


def test_the_order_of_terms_does_not_matter(rng):
    drawn = drawn_tube()
    posed = drawn.scene.pose_at(drawn.disturbed(rng))
    residuals = [term.find(posed, drawn.context(posed)) for term in TERMS.values()]
    sums = []
    for order in (residuals, residuals[::-1]):
        equations = NormalEquations.at(posed)
        for residual in order:
            residual.add_to(equations)
        sums.append(np.concatenate([part.ravel() for part in equations.assemble()]))
    np.testing.assert_allclose(sums[0], sums[1], rtol=1e-10, atol=1e-6)


def test_a_second_thread_changes_nothing_but_the_last_digits(rng):
    drawn = drawn_tube()
    start = drawn.disturbed(rng)
    fits = [
        fit_frame(drawn.scene, drawn.observation, start, start, Objective(), FitOptions(threads=threads))
        for threads in (1, 2, 2)
    ]
    np.testing.assert_allclose(fits[0].pose, fits[1].pose, atol=1e-9)
    np.testing.assert_array_equal(fits[1].pose, fits[2].pose)
    assert [list(costs) for costs in fits[0].costs] == [list(costs) for costs in fits[1].costs]


@every_term
def test_nothing_in_sight_gives_an_empty_residual(term):
    drawn = drawn_tube()
    away = drawn.scene.retract(drawn.pose, np.r_[0, 0, 3.0, 0, 0, 0, np.zeros(drawn.scene.num_dofs - 6)])
    posed = drawn.scene.pose_at(away)
    residual = term.find(posed, drawn.context(posed))
    if not isinstance(term, Silhouette | Uncovered):
        assert residual.count == 0
    assert residual.linearize(posed).jacobian.shape[1] == drawn.scene.num_dofs


def test_matches_of_model_to_data_are_the_nearest_points_allowed(rng):
    drawn = drawn_tube()
    posed = drawn.scene.pose_at(drawn.disturbed(rng))
    term = ModelToData()
    residual = term.find(posed, drawn.context(posed))
    seen = drawn.observation
    cloud = seen.points[seen.labels > 0].astype(float)
    normals = seen.normals[seen.labels > 0].astype(float)
    for corner, target, normal in zip(residual.ids[:, 0], residual.targets, residual.normals, strict=True):
        allowed = normals @ normal >= np.cos(np.deg2rad(term.max_angle))
        distances = np.linalg.norm(cloud[allowed] - posed.vertices[corner], axis=1)
        assert np.linalg.norm(target - posed.vertices[corner]) <= distances.min() + 2e-4  # the ring bound is lateral


@pytest.mark.parametrize("term", thin_terms, ids=lambda term: type(term).__name__)
def test_a_coarse_term_has_some_of_the_matches_and_no_others(term, rng):
    drawn = drawn_tube()
    posed = drawn.scene.pose_at(drawn.disturbed(rng))
    context = drawn.context(posed)
    whole, some = (t.find(posed, context).segments(posed) for t in (term, term.coarse()))
    assert 0 < len(some) < 0.7 * len(whole)
    if not isinstance(term, DataToSurface | Silhouette | Uncovered):  # their grids of pixels are shifted
        assert {tuple(s) for s in some.reshape(-1, 6)} <= {tuple(s) for s in whole.reshape(-1, 6)}


def test_a_contour_never_meets_the_opposite_contour_of_what_lies_beside_it():
    drawn = drawn_tube()
    aside = drawn.scene.retract(drawn.pose, np.r_[0.0, 0.015, 0.0, np.zeros(drawn.scene.num_dofs - 3)])
    posed = drawn.scene.pose_at(aside)
    context = drawn.context(posed)
    moves = {}
    for max_angle in (45.0, 180.0):
        found = DataToModel(weight=1.0, max_pixels=40, stride=1, max_angle=max_angle).find(posed, context)
        segments = found.segments(posed)
        moves[max_angle] = segments[:, 1, 1] - segments[:, 0, 1]
    assert np.median(moves[45.0]) < -0.010, "both contours go back by most of the 15 mm"
    assert np.mean(moves[45.0] > -0.003) < 0.1, "the end of the tube apart"
    assert np.mean(moves[180.0] > -0.003) > 0.2, "to whatever is nearest much of the tube stays where it is"

"""A model is fitted to points: gradients against finite differences, and fits that come back to the truth."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.registration.conftest import scan_model
from tracker.registration.model_fit import FitSettings, ModelFit, saturated, spread, weigh_matches
from tracker.registration.pose_prior import make_gaussian_prior
from tracker.registration.scan_points import ScanPoints
from tracker.registration.surface_search import Matches
from tracker.registration.vertex_fit import fit_to_vertices


def test_the_model_gradient_is_that_of_the_cost_with_the_search_repeated(fit, near, flat_triangles):
    state, points = near
    settings = FitSettings(8.0, 0, pose_weight=2.0, shape_weight=3.0)
    here = fit.evaluate(state, points, settings)
    _, Jtr = fit.linearize(here, points, settings)
    rng = np.random.default_rng(1)
    for _ in range(6):
        step = rng.normal(size=len(Jtr)) * fit.scales
        ahead, behind = (
            fit.evaluate(state.retract(fit.model, sign * 1e-5 * step), points, settings).cost for sign in (1.0, -1.0)
        )
        assert (ahead - behind) / 2e-5 == pytest.approx(2.0 * Jtr @ step, rel=2e-3, abs=0.05)


def test_what_the_model_gradient_leaves_out_of_curved_triangles_is_under_a_thirtieth(fit, near):
    state, points = near
    settings = FitSettings(8.0, 0)
    _, Jtr = fit.linearize(fit.evaluate(state, points, settings), points, settings)
    gradient = 2.0 * Jtr * fit.scales
    measured = np.empty(len(Jtr))
    for n in range(len(Jtr)):
        step = np.zeros(len(Jtr))
        step[n] = 1e-5 * fit.scales[n]
        ahead, behind = (fit.evaluate(state.retract(fit.model, sign * step), points, settings).cost for sign in (1, -1))
        measured[n] = (ahead - behind) / 2e-5
    assert np.linalg.norm(gradient - measured) < np.linalg.norm(measured) / 30


def test_every_step_that_is_taken_lowers_the_cost(fit, near):
    state, points = near
    costs = []
    for iterations in range(6):
        settings = FitSettings(8.0, iterations, to_scan=0.3, tolerance=0.0)
        costs.append(fit.fit(state, points, settings).cost)
    assert costs == sorted(costs, reverse=True) and costs[-1] < costs[0]


def test_a_registered_mesh_gives_back_pose_and_shape_whatever_the_start(fit, own_scan):
    state = fit_to_vertices(fit, fit.neutral(), own_scan.vertices, weight=1e-4)
    assert np.linalg.norm(state.posed(fit.model).vertices - own_scan.vertices, axis=1).max() < 1e-4


def test_a_prior_for_one_pose_draws_to_that_pose(fit):
    mean = 0.9 * fit.prior.mean
    prior = make_gaussian_prior(fit.prior, mean, 0.05**2 * np.eye(len(mean)))
    at, away = prior.cost(mean.reshape(-1, 3)), prior.cost(mean.reshape(-1, 3) + 0.2)
    assert at == pytest.approx(0.0, abs=1e-12) and away > 100.0
    held = ModelFit(fit.model, prior)
    own = scan_model(3, 300)
    state = held.fit(held.neutral(), ScanPoints(own.scan.points + 5.0, own.scan.normals), FitSettings(5.0, 5)).state
    assert state.pose[1:].ravel() == pytest.approx(mean, abs=1e-3)


def test_the_neutral_state_is_the_middle_of_the_prior_and_costs_nothing(fit):
    state = fit.neutral()
    JtJ, Jtr = fit.prior_equations(state, 1.0, 1.0)
    assert fit.prior_cost(state, 1.0, 1.0) == pytest.approx(0.0, abs=1e-12)
    assert not Jtr.any() and not JtJ[:6].any() and (JtJ.diagonal()[6:] > 0.0).all()


def test_the_prior_gradient_is_that_of_its_cost_and_each_part_has_its_weight(fit, near):
    state = near[0].retract(
        fit.model, 0.3 * np.random.default_rng(2).normal(size=fit.model.num_parameters) * fit.scales
    )
    _, Jtr = fit.prior_equations(state, 2.0, 3.0)
    for n in range(0, len(Jtr), 4):
        step = 1e-6 * np.eye(len(Jtr))[n]
        ahead, behind = (fit.prior_cost(state.retract(fit.model, sign * step), 2.0, 3.0) for sign in (1.0, -1.0))
        assert (ahead - behind) / 2e-6 == pytest.approx(2.0 * Jtr[n], rel=1e-5, abs=1e-4)
    parts = fit.prior_cost(state, 1.0, 0.0), fit.prior_cost(state, 0.0, 1.0)
    assert min(parts) > 0.1
    assert fit.prior_cost(state, 2.0, 3.0) == pytest.approx(2.0 * parts[0] + 3.0 * parts[1])


def test_a_point_that_nothing_is_near_costs_what_one_at_the_reach_does_and_pulls_nothing():
    offsets = np.array([0.0, 0.005, -0.020, 0.0, 0.003])
    faces = np.array([0, 1, 2, -1, 3])
    on_rim = np.array([False, False, False, False, True])
    none = np.zeros((5, 3))
    weights, total = weigh_matches(Matches(faces, none, none, offsets, np.zeros(5), on_rim), 0.020, 0.005)
    rho = offsets**2 * 0.005**2 / (0.005**2 + offsets**2)
    assert saturated(0.020, 0.005) == pytest.approx(rho[2])
    assert total == pytest.approx(rho[[0, 1, 2, 4]].sum() + rho[2])
    np.testing.assert_allclose(weights[:3], [1.0, 0.25, (1.0 / 17.0) ** 2])
    assert weights[3] == weights[4] == 0.0


def test_vertices_look_back_at_the_nearest_point_that_looks_their_way(fit, near, own_scan):
    state, _ = near
    vertices = state.posed(fit.model).vertices
    scan = ScanPoints(own_scan.scan.points[:3000], own_scan.scan.normals[:3000])
    back = fit.look_back(vertices, scan, 0.010, 300)
    apart = np.linalg.norm(vertices[fit.inner[:300], None] - scan.points, axis=2)
    nearest = apart.argmin(axis=1)
    is_near = apart.min(axis=1) < 0.010
    np.testing.assert_allclose(back.distances[is_near], apart.min(axis=1)[is_near])
    assert np.isinf(back.distances[~is_near]).all() and not back.is_used[~is_near].any()
    used = back.is_used
    assert used.mean() > 0.8
    np.testing.assert_array_equal(back.normals[used], scan.normals[nearest[used]])
    towards = vertices[fit.inner[:300]] - scan.points[nearest]
    np.testing.assert_allclose(back.along[used], np.einsum("nd,nd->n", towards, scan.normals[nearest])[used])
    inside_out = fit.look_back(vertices, ScanPoints(scan.points, -scan.normals), 0.010, 300)
    assert not (inside_out.is_used & used).any()


def test_points_without_normals_are_met_from_whatever_side_by_their_distance(fit, near, own_scan):
    vertices = near[0].posed(fit.model).vertices
    scan = ScanPoints(own_scan.scan.points[:3000], np.zeros((3000, 3)))
    back = fit.look_back(vertices, scan, 0.010)
    assert len(back.is_used) == len(fit.inner)
    np.testing.assert_array_equal(back.is_used, np.isfinite(back.distances))
    np.testing.assert_array_equal(back.along, back.distances)
    np.testing.assert_allclose(np.linalg.norm(back.normals[back.is_used], axis=1), 1.0)


def test_spread_takes_the_farthest_of_the_wanted_next_and_any_first_of_them_lie_evenly():
    rng = np.random.default_rng(6)
    vertices, wanted = rng.normal(size=(60, 3)), rng.random(60) < 0.7
    order = spread(vertices, wanted)
    assert sorted(order) == np.flatnonzero(wanted).tolist()
    for count in range(1, len(order)):
        left = np.setdiff1d(order, order[:count])
        gaps = np.linalg.norm(vertices[left, None] - vertices[order[:count]], axis=2).min(axis=1)
        assert np.linalg.norm(vertices[order[:count]] - vertices[order[count]], axis=1).min() == gaps.max()
    np.testing.assert_array_equal(spread(vertices, wanted, 7), order[:7])

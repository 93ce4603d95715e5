"""Gradients against finite differences, steps against dense algebra, and fits that come back to the truth."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.registration.conftest import scan_model
from tracker.model.untrained_hand import untrained_hand
from tracker.registration import surface_search
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.equations import add_model_rows, weigh_robustly
from tracker.registration.free_fit import FreeFit, FreeSettings, FreeSurface
from tracker.registration.model_fit import MM, FitSettings, ModelFit
from tracker.registration.pose_prior import make_gaussian_prior
from tracker.registration.scan_points import ScanPoints
from tracker.registration.vertex_fit import fit_to_vertices


@pytest.fixture(scope="module")
def fit() -> ModelFit:
    hand = untrained_hand()
    return ModelFit(hand, make_anatomical_prior(hand))


@pytest.fixture(scope="module")
def near(fit, own_scan):
    """A state some millimetres off, and 400 points away from the rim, where the cost is smooth."""
    rng = np.random.default_rng(0)
    state = fit_to_vertices(fit, fit.neutral(), own_scan.vertices)
    state = state.retract(fit.model, 0.02 * rng.normal(size=fit.model.num_parameters) * fit.scales)
    points = ScanPoints(own_scan.scan.points[:2000], own_scan.scan.normals[:2000])
    found = fit.search.match(state.posed(fit.model).vertices, points.points, points.normals, 0.03)
    ids = np.flatnonzero(~found.on_rim & (found.faces >= 0))[:400]
    return state, ScanPoints(points.points[ids], points.normals[ids])


@pytest.fixture
def flat_triangles(monkeypatch):
    """Where no triangle bulges the derivatives are exact; how they bulge is held otherwise."""
    monkeypatch.setattr(surface_search, "find_bulges", lambda vertices, faces: np.zeros((len(faces), 3, 3)))


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


def test_rows_add_up_as_plain_numpy_adds_them():
    rng = np.random.default_rng(2)
    J, corners = rng.normal(size=(20, 3, 9)), rng.integers(0, 20, (50, 3)).astype(np.int32)
    shares, directions = rng.dirichlet([1, 1, 1], 50), rng.normal(size=(50, 3))
    residuals, weights = rng.normal(size=50), rng.uniform(size=50)
    JtJ, Jtr = np.zeros((9, 9)), np.zeros(9)
    add_model_rows(JtJ, Jtr, J, corners, shares, directions, residuals, weights)
    rows = np.einsum("nd,nk,nkdp->np", directions, shares, J[corners])
    assert np.tril(JtJ) == pytest.approx(np.tril(rows.T @ (weights[:, None] * rows)))
    assert Jtr == pytest.approx(rows.T @ (weights * residuals))


def test_geman_mcclure_weights_are_the_derivative_of_its_cost():
    r = np.linspace(-0.03, 0.03, 41)
    weights, step = np.empty(41), 1e-7
    weigh_robustly(weights, r, 0.005)
    for value, weight in zip(r, weights, strict=True):
        ahead, behind = (weigh_robustly(np.empty(1), np.array([value + s]), 0.005) for s in (step, -step))
        assert (ahead - behind) / (2 * step) == pytest.approx(2.0 * weight * value, rel=1e-5, abs=1e-9)


def test_the_free_gradient_is_that_of_the_cost_with_the_search_repeated(fit, near, flat_triangles):
    state, points = near
    free, settings = FreeFit(fit), FreeSettings(0.5, 8.0, 0, 0.7, 0.9)
    vertices = state.posed(fit.model).vertices + 3e-4 * np.random.default_rng(3).normal(
        size=(len(fit.model.template), 3)
    )
    here = free.evaluate(vertices, state, points, settings, None)
    system = free.linearize(here, settings)
    rng = np.random.default_rng(4)
    for _ in range(5):
        step = rng.normal(size=len(system.gradient))
        costs = []
        for sign in (1.0, -1.0):
            turn, move = free.split(sign * 1e-6 * step)
            costs.append(free.evaluate(vertices + move, state.retract(fit.model, turn), points, settings, None).cost)
        assert (costs[0] - costs[1]) / 2e-6 == pytest.approx(2.0 * system.gradient @ step, rel=3e-3, abs=0.1)


def test_the_sparse_newton_step_solves_the_whole_dense_system(fit, near):
    state, points = near
    free, settings = FreeFit(fit), FreeSettings(0.5, 8.0, 0, 0.7, 0.9)
    here = free.evaluate(state.posed(fit.model).vertices, state, points, settings, None)
    system = free.linearize(here, settings)
    rng = np.random.default_rng(5)
    promised = -2.0 * system.gradient @ system.newton - system.curvature(system.newton)
    for _ in range(20):  # no other step of the quadratic model is better
        other = system.newton + 0.05 * rng.normal(size=len(system.newton))
        assert -2.0 * system.gradient @ other - system.curvature(other) < promised
    assert system.curvature(system.newton) == pytest.approx(-system.gradient @ system.newton, rel=1e-3)


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


def test_free_vertices_follow_a_bulge_that_the_model_cannot_make(fit, own_scan):
    state = fit_to_vertices(fit, fit.neutral(), own_scan.vertices)
    posed = state.posed(fit.model)
    bulge = np.exp(-((own_scan.scan.points - posed.vertices[300]) ** 2).sum(axis=1) / 0.008**2)
    points = ScanPoints(own_scan.scan.points + 0.003 * bulge[:, None] * own_scan.scan.normals, own_scan.scan.normals)
    free = FreeFit(fit)
    start = fit.evaluate(state, points, FitSettings(10.0, 0))
    surface = FreeSurface(posed.vertices, state, posed.vertices, start.matches, start.weights, 0.0)
    for coupling in (1.0, 0.03):
        surface = free.fit(surface, points, FreeSettings(coupling, 5.0, 6))
    found = fit.search.match(surface.vertices, points.points, points.normals, 0.01)
    top = (bulge > 0.7) & (found.faces >= 0)
    assert np.abs(found.offsets[top]).mean() * MM < 0.5
    assert np.abs(start.matches.offsets[top]).mean() * MM > 1.5


def test_a_prior_for_one_pose_draws_to_that_pose(fit):
    mean = 0.9 * fit.prior.mean
    prior = make_gaussian_prior(fit.prior, mean, 0.05**2 * np.eye(len(mean)))
    at, away = prior.cost(mean.reshape(-1, 3)), prior.cost(mean.reshape(-1, 3) + 0.2)
    assert at == pytest.approx(0.0, abs=1e-12) and away > 100.0
    held = ModelFit(fit.model, prior)
    own = scan_model(3, 300)
    state = held.fit(held.neutral(), ScanPoints(own.scan.points + 5.0, own.scan.normals), FitSettings(5.0, 5)).state
    assert state.pose[1:].ravel() == pytest.approx(mean, abs=1e-3)

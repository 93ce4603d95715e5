"""Free vertices coupled to a model: gradients against differences, steps against the dense system."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.errors import SolveError
from tracker.registration.free_fit import FreeFit, FreeSettings, FreeSurface
from tracker.registration.model_fit import MM, FitSettings
from tracker.registration.scan_points import ScanPoints
from tracker.registration.vertex_fit import fit_to_vertices


@pytest.fixture(scope="module")
def free(fit) -> FreeFit:
    return FreeFit(fit)


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


def test_the_coupling_is_the_stretch_of_every_edge_against_the_model_once(fit, near, free):
    state, points = near
    model = state.posed(fit.model).vertices
    vertices = model + 1e-3 * np.random.default_rng(6).normal(size=model.shape)
    costs = [free.evaluate(vertices, state, points, FreeSettings(c, 8.0, 0), None).cost for c in (0.0, 0.5, 2.0)]
    faces = fit.search.faces
    edges = {tuple(sorted(pair)) for face in faces for pair in (face[[0, 1]], face[[1, 2]], face[[2, 0]])}
    a, b = np.array(sorted(edges)).T
    apart = MM * (vertices - model)
    stretch = np.sum((apart[a] - apart[b]) ** 2)
    assert costs[1] - costs[0] == pytest.approx(0.5 * stretch)
    assert costs[2] - costs[0] == pytest.approx(2.0 * stretch)


def test_a_surface_that_moves_as_a_whole_stretches_nothing_and_says_how_far(fit, near, free):
    state, _ = near
    model = state.posed(fit.model).vertices
    away = np.array([0.3, -0.2, 0.1])
    nothing = ScanPoints(np.full((5, 3), 9.0), np.zeros((5, 3)))
    here, there = (
        free.evaluate(model + by, state, nothing, FreeSettings(5.0, 8.0, 0), None) for by in (np.zeros(3), away)
    )
    assert there.cost == pytest.approx(here.cost)
    np.testing.assert_allclose(there.offset, away, atol=1e-12)
    np.testing.assert_allclose(here.offset, 0.0, atol=1e-12)


def test_curvature_is_the_square_of_the_whole_dense_matrix(fit, near, free):
    """step' H step against what the gradient gains along the step."""
    state, points = near
    settings = FreeSettings(0.5, 8.0, 0)
    here = free.evaluate(state.posed(fit.model).vertices, state, points, settings, None)
    system = free.linearize(here, settings)
    rng = np.random.default_rng(7)
    one, two = rng.normal(size=(2, len(system.gradient)))
    both, apart = system.curvature(one + two), system.curvature(one - two)
    assert both + apart == pytest.approx(2.0 * (system.curvature(one) + system.curvature(two)))
    assert system.curvature(3.0 * one) == pytest.approx(9.0 * system.curvature(one))
    assert min(both, apart) > 0.0 and system.curvature(np.zeros_like(one)) == 0.0


def test_steps_are_split_into_the_model_s_and_the_vertices_in_their_units(fit, free):
    count = len(fit.model.template)
    turn, moved = free.split(np.ones(len(fit.scales) + 3 * count))
    np.testing.assert_array_equal(turn, fit.scales)
    np.testing.assert_array_equal(moved, np.full((count, 3), 0.01))


def test_equations_that_are_not_definite_are_refused(fit, near, free):
    state, points = near
    settings = FreeSettings(0.5, 8.0, 0)
    here = free.evaluate(state.posed(fit.model).vertices, state, points, settings, None)
    with pytest.raises(SolveError, match="free surface have no minimum; needed points and a coupling above 0"):
        free.linearize(here, replace(settings, coupling=-5.0))
    with pytest.raises(SolveError, match="model's equations are not positive definite"):
        free.linearize(here, replace(settings, pose_weight=-1e9))


def test_seeds_of_another_scan_are_not_used(fit, near, free):
    state, points = near
    vertices = state.posed(fit.model).vertices
    settings = FreeSettings(0.5, 8.0, 0)
    whole = free.evaluate(vertices, state, points, settings, None)
    fewer = points.first(150)
    fresh, seeded = (free.evaluate(vertices, state, fewer, settings, seeds) for seeds in (None, whole.matches))
    assert seeded.cost == fresh.cost
    np.testing.assert_array_equal(seeded.matches.faces, fresh.matches.faces)

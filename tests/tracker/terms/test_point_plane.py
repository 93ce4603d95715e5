"""Distances of surface points from planes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.terms.surface_picks import measure_slopes, pick_directions, pick_points, tube_and_ball
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.point_plane import PointToPlane


@pytest.fixture
def posed(rng):
    return tube_and_ball(rng)


@pytest.fixture
def planes(posed, rng) -> PointToPlane:
    """Thirty, a few centimetres from the surface, of different weights."""
    ids, shares = pick_points(posed, 30, rng)
    targets = np.einsum("nc,nci->ni", shares, posed.vertices[ids]) + rng.normal(scale=0.02, size=(30, 3))
    return PointToPlane(ids, shares, targets, pick_directions(30, rng), rng.uniform(0.1, 2.0, 30))


def test_the_residual_is_the_signed_distance_from_the_plane_in_mm(posed, planes):
    block = planes.linearize(posed)
    points = planes.points(posed)
    feet = points - (block.residual / 1000.0)[:, None] * planes.normals
    np.testing.assert_allclose(np.einsum("ni,ni->n", feet - planes.targets, planes.normals), 0.0, atol=1e-12)
    above = replace(planes, targets=points - 0.003 * planes.normals)
    np.testing.assert_allclose(above.linearize(posed).residual, 3.0, atol=1e-9)


def test_the_gradient_of_the_fast_sum_is_that_of_its_own_cost(posed, planes):
    equations = NormalEquations.at(posed)
    planes.add_to(equations)
    slopes = measure_slopes(lambda at: planes.linearize(at).cost, posed)
    Jtr = equations.assemble()[1]
    np.testing.assert_allclose(2.0 * Jtr, slopes, atol=1e-6 * np.abs(slopes).max())


def test_moving_a_plane_within_itself_changes_nothing(posed, planes, rng):
    aside = np.cross(planes.normals, rng.normal(size=(30, 3)))
    slid = replace(planes, targets=planes.targets + aside)
    np.testing.assert_allclose(slid.linearize(posed).residual, planes.linearize(posed).residual, atol=1e-9)
    sums = [NormalEquations.at(posed), NormalEquations.at(posed)]
    for each, equations in zip((planes, slid), sums, strict=True):
        each.add_to(equations)
    np.testing.assert_allclose(sums[1].cost, sums[0].cost, rtol=1e-9)
    here, there = (equations.assemble()[1] for equations in sums)
    np.testing.assert_allclose(there, here, atol=1e-6 * np.abs(here).max())


def test_a_weight_scales_its_row_and_a_row_of_weight_zero_only_counts(posed, planes):
    silent = replace(planes, weights=np.zeros(30))
    equations = NormalEquations.at(posed)
    silent.add_to(equations)
    assert (equations.cost, equations.count) == (0.0, 30)
    assert not equations.blocks.any() and not equations.gradients.any()
    twice = replace(planes, weights=2.0 * planes.weights)
    assert twice.linearize(posed).cost == pytest.approx(2.0 * planes.linearize(posed).cost)


def test_a_line_is_drawn_from_each_surface_point_to_its_target_and_none_for_no_rows(posed, planes):
    segments = planes.segments(posed)
    np.testing.assert_array_equal(segments[:, 0], planes.points(posed))
    np.testing.assert_array_equal(segments[:, 1], planes.targets)
    none = PointToPlane(planes.ids[:0], planes.barycentric[:0], planes.targets[:0], planes.normals[:0], np.zeros(0))
    block = none.linearize(posed)
    assert (none.count, block.cost, block.jacobian.shape) == (0, 0.0, (0, posed.scene.num_dofs))
    assert none.segments(posed).shape == (0, 2, 3)

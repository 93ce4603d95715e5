"""Distances of surface points from lines in Plücker coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.terms.surface_picks import measure_slopes, pick_directions, pick_points, tube_and_ball
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.point_line import PointToLine, find_slack


@pytest.fixture
def posed(rng):
    return tube_and_ball(rng)


@pytest.fixture
def lines(posed, rng) -> PointToLine:
    """Thirty, and three along the axes, all a few centimetres from the surface."""
    ids, shares = pick_points(posed, 33, rng)
    directions = np.concatenate([pick_directions(30, rng), np.eye(3)])
    through = np.einsum("nc,nci->ni", shares, posed.vertices[ids]) + rng.normal(scale=0.02, size=(33, 3))
    return PointToLine(ids, shares, directions, np.cross(through, directions), rng.uniform(0.1, 2.0, 33))


def measure_plainly(lines: PointToLine, points: np.ndarray) -> np.ndarray:
    """(N,) distances, m: from two points of each line, by the area of a triangle."""
    first = np.cross(lines.directions, lines.moments)
    second = first + lines.directions
    return np.linalg.norm(np.cross(points - first, points - second), axis=1)


def test_the_three_rows_of_a_line_are_together_its_distance_in_mm(posed, lines):
    block = lines.linearize(posed)
    apart = 1000.0 * measure_plainly(lines, lines.points(posed))
    assert apart.min() > 1.0
    np.testing.assert_allclose(np.linalg.norm(block.residual.reshape(-1, 3), axis=1), apart, rtol=1e-9)
    np.testing.assert_array_equal(block.weights, np.repeat(lines.weights, 3))
    assert block.cost == pytest.approx(np.sum(lines.weights * apart**2))


def test_two_rows_of_the_fast_sum_measure_what_three_do_whatever_the_direction(posed, lines):
    for n in range(lines.count):
        rows = slice(n, n + 1)
        line = PointToLine(
            lines.ids[rows], lines.barycentric[rows], lines.directions[rows], lines.moments[rows], lines.weights[rows]
        )
        block, equations = line.linearize(posed), NormalEquations.at(posed)
        line.add_to(equations)
        JtJ, Jtr = equations.assemble()
        weighted = block.jacobian * block.weights[:, None]
        np.testing.assert_allclose(JtJ, weighted.T @ block.jacobian, atol=1e-9 * np.abs(JtJ).max())
        np.testing.assert_allclose(Jtr, weighted.T @ block.residual, atol=1e-9 * np.abs(JtJ).max())
        assert equations.cost == pytest.approx(block.cost) and equations.count == 1


def test_the_gradient_is_that_of_the_cost(posed, lines):
    equations = NormalEquations.at(posed)
    lines.add_to(equations)
    slopes = measure_slopes(
        lambda at: np.sum(lines.weights * (1000.0 * measure_plainly(lines, lines.points(at))) ** 2), posed
    )
    np.testing.assert_allclose(2.0 * equations.assemble()[1], slopes, atol=1e-6 * np.abs(slopes).max())


def test_a_line_that_points_the_other_way_is_the_same_line(posed, lines):
    turned = replace(lines, directions=-lines.directions, moments=-lines.moments)
    assert turned.linearize(posed).cost == pytest.approx(lines.linearize(posed).cost)
    np.testing.assert_allclose(turned.segments(posed), lines.segments(posed), atol=1e-12)


def test_a_segment_goes_square_from_the_surface_to_the_line(posed, lines):
    segments = lines.segments(posed)
    np.testing.assert_array_equal(segments[:, 0], lines.points(posed))
    across = segments[:, 1] - segments[:, 0]
    np.testing.assert_allclose(np.einsum("ni,ni->n", across, lines.directions), 0.0, atol=1e-12)
    np.testing.assert_allclose(measure_plainly(lines, segments[:, 1]), 0.0, atol=1e-12)


def test_slack_is_one_on_the_line_four_at_its_reach_and_makes_the_cost_level_off(lines, rng):
    directions, moments = lines.directions, lines.moments
    on = np.cross(directions, moments) + rng.normal(size=(33, 1)) * directions
    np.testing.assert_allclose(find_slack(on, directions, moments, 5.0), 1.0, atol=1e-9)
    across = np.cross(directions, rng.normal(size=(33, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    np.testing.assert_allclose(find_slack(on + 0.005 * across, directions, moments, 5.0), 4.0)
    pulls = [d / find_slack(on + d * across, directions, moments, 5.0) for d in (0.002, 0.004, 0.050, 0.500)]
    assert (pulls[0] < pulls[1]).all() and (pulls[1] > pulls[2]).all() and (pulls[2] > 100.0 * pulls[3]).all()

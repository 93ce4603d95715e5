"""Residuals of several terms together, and what terms are told of a frame."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.scenes import drawn_tube
from tests.tracker.terms.surface_picks import pick_directions, pick_points, tube_and_ball
from tracker.terms.collision import Collision
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.point_line import PointToLine
from tracker.terms.point_plane import PointToPlane
from tracker.terms.point_point import PointToPoint
from tracker.terms.residual import JointResidual, ResidualBlock, Thinnable


@pytest.fixture
def posed(rng):
    return tube_and_ball(rng)


@pytest.fixture
def parts(posed, rng):
    """Four planes, two lines and three points."""
    ids, shares = pick_points(posed, 4, rng)
    u = pick_directions(4, rng)
    targets = rng.normal(size=(4, 3))
    return {
        "planes": PointToPlane(ids, shares, targets, u, np.ones(4)),
        "lines": PointToLine(ids[:2], shares[:2], u[:2], np.cross(targets[:2], u[:2]), np.full(2, 0.5)),
        "points": PointToPoint.of_vertices(ids[:3, 0], targets[:3], 2.0),
    }


def test_the_cost_of_a_block_is_the_weighted_sum_of_squares_and_zero_of_no_rows():
    block = ResidualBlock(np.array([3.0, -4.0]), np.zeros((2, 5)), np.array([2.0, 0.5]))
    assert block.cost == 2.0 * 9.0 + 0.5 * 16.0
    assert ResidualBlock(np.zeros(0), np.zeros((0, 5)), np.zeros(0)).cost == 0.0


def test_parts_stand_one_behind_the_other_in_their_order(posed, parts):
    together = JointResidual(parts)
    block = together.linearize(posed)
    assert together.count == 4 + 2 + 3
    assert len(block.residual) == 4 + 3 * 2 + 3 * 3
    own = [part.linearize(posed) for part in parts.values()]
    for name in ("residual", "jacobian", "weights"):
        np.testing.assert_array_equal(getattr(block, name), np.concatenate([getattr(each, name) for each in own]))
    np.testing.assert_array_equal(
        together.segments(posed), np.concatenate([part.segments(posed) for part in parts.values()])
    )
    assert block.cost == pytest.approx(sum(each.cost for each in own))


def test_the_fast_sum_of_parts_is_that_of_their_rows_and_counts_matches_not_rows(posed, parts):
    together, equations = JointResidual(parts), NormalEquations.at(posed)
    together.add_to(equations)
    block = together.linearize(posed)
    JtJ, Jtr = equations.assemble()
    weighted = block.jacobian * block.weights[:, None]
    np.testing.assert_allclose(JtJ, weighted.T @ block.jacobian, atol=1e-10 * np.abs(JtJ).max())
    np.testing.assert_allclose(Jtr, weighted.T @ block.residual, atol=1e-10 * np.abs(Jtr).max())
    assert (equations.count, equations.cost) == (9, pytest.approx(block.cost))


def test_a_frame_tells_kernels_of_the_drawn_scene_and_of_what_was_seen_pixel_by_pixel():
    scene = drawn_tube()
    posed = scene.scene.pose_at(scene.pose)
    context = scene.context(posed)
    drawn = context.drawn
    assert context.drawn is drawn, "they are gathered once"
    seen, view = scene.observation, context.view
    for image in (drawn.inverse_depth, drawn.face, drawn.depth, drawn.labels, drawn.points[..., 0]):
        assert image.shape == seen.labels.shape
    for own, source in (
        (drawn.depth, seen.depth),
        (drawn.edges, seen.edges),
        (drawn.nearest, seen.nearest_pixel),
        (drawn.T, seen.T_world_camera),
        (drawn.vertices, posed.vertices),
        (drawn.face, view.face),
        (drawn.projected, view.projected),
    ):
        assert own is source
    has_both = (drawn.face >= 0) & (drawn.depth > 0.0)
    np.testing.assert_allclose(1.0 / drawn.inverse_depth[has_both], drawn.depth[has_both], atol=1e-5)


def test_a_term_that_can_do_with_fewer_matches_says_so_by_having_a_coarse_form():
    assert isinstance(DataToSurface(), Thinnable)
    assert not isinstance(Collision(), Thinnable)

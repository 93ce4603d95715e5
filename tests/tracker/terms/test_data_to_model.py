"""Discontinuities of the drawn model meet those of the image, on their viewing rays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import DrawnScene, drawn_tube
from tracker.geometry import se3
from tracker.observation.depth_edges import find_fall
from tracker.terms.data_to_model import DataToModel

ELSEWHERE = se3.exp(np.array([0.4, -0.2, 0.7, 0.3, -0.8, 0.5]))
WIDE = DataToModel(stride=1, max_pixels=12, max_angle=50.0)
"""No two directions of discontinuities are apart by just this angle, as many are by 45 degrees."""


@pytest.fixture(scope="module")
def drawn() -> DrawnScene:
    return drawn_tube(ELSEWHERE)


@pytest.fixture
def posed(drawn):
    return drawn.scene.pose_at(drawn.disturbed(np.random.default_rng(0)))


def find_plainly(drawn: DrawnScene, context, term: DataToModel):
    """(column, row) of each matched discontinuity of the model and of the image's that it meets."""
    seen, view = drawn.observation, context.view
    depth = np.where(view.face >= 0, view.depth, np.inf)
    edges = np.argwhere(seen.edges[1])
    falls = np.array([find_fall(seen.depth, False, r, c, term.jump) for r, c in edges])
    K = seen.K
    for row in range(1, depth.shape[0] - 1):
        for column in range(1, depth.shape[1] - 1):
            z = depth[row, column]
            around = [depth[row + dr, column + dc] for dr, dc in ((0, 1), (0, -1), (1, 0), (-1, 0))]
            if not np.isfinite(z) or (row + column) % term.stride or max(around) <= z + term.jump:
                continue
            fall = np.array(find_fall(view.inverse_depth, True, row, column, term.jump))
            apart = np.hypot(*(edges - (row, column)).T)
            apart[falls @ fall < np.cos(np.deg2rad(term.max_angle))] = np.inf
            if apart.min() > term.max_pixels:
                continue
            nearest = np.flatnonzero(apart == apart.min())
            for r, c in edges[nearest]:  # pixels as near as each other are alike
                block = seen.depth[max(0, r - 1) : r + 2, max(0, c - 1) : c + 2]
                mean = block[block > 0].mean()
                there = np.linalg.solve(K, [c, r, 1.0]) * mean
                here = np.linalg.solve(K, [column, row, 1.0]) * z
                yield (column, row), (c, r), np.linalg.norm(there - here) <= term.max_distance, len(nearest)


def look_into(drawn: DrawnScene, points: np.ndarray) -> np.ndarray:
    """(N, 2) px in the region's image."""
    here = se3.transform(se3.inverse(drawn.camera.T_world_camera), points)
    return here[:, :2] / here[:, 2:] * drawn.observation.K[[0, 1], [0, 1]] + drawn.observation.K[:2, 2]


def test_matches_are_those_of_a_plain_loop(drawn, posed):
    context = drawn.context(posed)
    residual = WIDE.find(posed, context)
    contour = np.rint(look_into(drawn, residual.points(posed))).astype(int)
    met = np.rint(look_into(drawn, residual.segments(posed)[:, 1])).astype(int)
    choices: dict[tuple[int, int], set] = {}
    certain = set()
    for own, edge, is_near, count in find_plainly(drawn, context, WIDE):
        if is_near:
            choices.setdefault(own, set()).add(edge)
            if count == 1:
                certain.add(own)
    found = dict(zip(map(tuple, contour.tolist()), map(tuple, met.tolist()), strict=True))
    assert len(found) == residual.count > 100
    assert certain <= set(found) <= set(choices)
    assert all(edge in choices[own] for own, edge in found.items())


def test_each_line_is_the_viewing_ray_of_a_discontinuity_of_the_image(drawn, posed):
    residual = DataToModel().find(posed, drawn.context(posed))
    eye = drawn.camera.T_world_camera[:3, 3]
    np.testing.assert_allclose(np.linalg.norm(residual.directions, axis=1), 1.0)
    np.testing.assert_allclose(residual.moments, np.cross(eye, residual.directions), atol=1e-12)
    pixels = look_into(drawn, eye + residual.directions)
    columns, rows = np.rint(pixels).astype(int).T
    np.testing.assert_allclose(pixels, np.column_stack([columns, rows]), atol=1e-6)
    assert drawn.observation.edges[1, rows, columns].all()


def test_nothing_is_met_beyond_the_limits_in_pixels_or_metres(drawn, posed):
    context = drawn.context(posed)
    near = replace(WIDE, max_pixels=3).find(posed, context)
    moves = look_into(drawn, near.segments(posed)[:, 1]) - look_into(drawn, near.points(posed))
    assert 0 < near.count < WIDE.find(posed, context).count
    assert np.linalg.norm(moves, axis=1).max() <= 3.0 + 0.1
    close = replace(WIDE, max_distance=0.008).find(posed, context)
    segments = close.segments(posed)
    assert 0 < close.count < WIDE.find(posed, context).count
    assert np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).max() <= 0.008


def test_at_vertices_each_match_is_the_nearest_visible_vertex_of_its_pixel(drawn, posed):
    context = drawn.context(posed)
    residual = replace(WIDE, at_vertices=True).find(posed, context)
    assert residual.count > 10
    assert (residual.ids == residual.ids[:, :1]).all()
    np.testing.assert_array_equal(residual.barycentric, np.tile([1.0, 0.0, 0.0], (residual.count, 1)))
    pixels = np.rint(look_into(drawn, posed.vertices)).astype(int)
    depths = se3.transform(se3.inverse(drawn.camera.T_world_camera), posed.vertices)[:, 2]
    for vertex in residual.ids[:, 0]:
        column, row = pixels[vertex]
        assert depths[vertex] <= context.view.depth[row, column] + 0.003
        same = np.all(pixels == pixels[vertex], axis=1)
        assert depths[vertex] == depths[same].min()


def test_a_discontinuity_of_hands_is_not_one_of_things(drawn, posed):
    context, seen = drawn.context(posed), drawn.observation
    for kind, is_met in ((0, True), (1, False)):
        edges = seen.edges.copy()
        edges[kind] = 0
        found = WIDE.find(posed, replace(context, observation=replace(seen, edges=edges)))
        assert (found.count > 0) == is_met


def test_the_coarse_form_takes_every_other_of_the_same_matches(drawn, posed):
    context = drawn.context(posed)
    fine, coarse = (look_into(drawn, t.find(posed, context).points(posed)) for t in (WIDE, WIDE.coarse()))
    kept = np.rint(fine).astype(int).sum(axis=1) % 2 == 0
    np.testing.assert_allclose(coarse, fine[kept], atol=1e-6)


def test_before_an_image_without_discontinuities_nothing_is_matched(drawn, posed):
    context, seen = drawn.context(posed), drawn.observation
    flat = replace(context, observation=replace(seen, edges=np.zeros_like(seen.edges)))
    residual = WIDE.find(posed, flat)
    assert (residual.count, residual.linearize(posed).cost) == (0, 0.0)

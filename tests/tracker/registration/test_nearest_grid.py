"""A look into the grid finds a point about as near as the nearest, wherever one looks, and in the mirror too."""

import numpy as np
import pytest

from tracker.registration.nearest_grid import CELL, MARGIN, build_nearest_grid, look_up

rng = np.random.default_rng(0)
POINTS = rng.uniform(-0.06, 0.06, (800, 3))
NORMALS = np.tile([0.0, 0.0, 1.0], (800, 1))


@pytest.fixture(scope="module")
def grid():
    return build_nearest_grid(POINTS, NORMALS)


def test_what_is_found_is_at_most_a_cell_farther_than_the_nearest(grid):
    asked = rng.uniform(-0.08, 0.08, (500, 3))
    found = np.array([look_up(grid.nearest, grid.origin, *place) for place in asked])
    away = np.linalg.norm(asked - POINTS[found], axis=1)
    nearest = np.linalg.norm(asked[:, None] - POINTS, axis=2).min(axis=1)
    # the middle of the cell is half its diagonal away at most, and the tree may be a tenth off
    assert (away <= 1.1 * (nearest + np.sqrt(3.0) * CELL)).all()


def test_each_point_lies_inside_the_grid_with_the_margin_around_it(grid):
    high = grid.origin + CELL * np.array(grid.nearest.shape)
    assert (POINTS.min(axis=0) - grid.origin == pytest.approx(MARGIN)) and (high - POINTS.max(axis=0) >= MARGIN).all()


def test_beyond_the_grid_the_cell_at_its_border_answers(grid):
    far = look_up(grid.nearest, grid.origin, 9.0, -9.0, 9.0)
    assert far == grid.nearest[-1, 0, -1]


def test_the_mirrored_grid_answers_in_the_mirror(grid):
    mirrored = grid.mirrored()
    for place in rng.uniform(-0.08, 0.08, (200, 3)):
        there = look_up(mirrored.nearest, mirrored.origin, -place[0], place[1], place[2])
        assert there == look_up(grid.nearest, grid.origin, *place)
    assert mirrored.points == pytest.approx(POINTS * [-1.0, 1.0, 1.0])

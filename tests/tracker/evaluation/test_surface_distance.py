"""Distances to a mesh are exact."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from tests.tracker.toys import tube
from tracker.evaluation.surface_distance import compute_surface_distances


def distance_by_least_squares(point: np.ndarray, corners: np.ndarray) -> float:
    """To a triangle (3, 3): non-negative barycentric coordinates that sum to one, by a heavy row."""
    heavy = 1e4
    system = np.vstack([corners.T, np.full((1, 3), heavy)])
    shares, _ = nnls(system, np.append(point, heavy))
    return float(np.linalg.norm(corners.T @ (shares / shares.sum()) - point))


def test_points_all_around_a_triangle_have_the_distance_that_least_squares_finds(rng):
    corners = np.array([[0.0, 0, 0], [1.0, 0.2, 0], [0.3, 0.9, 0.4]])
    points = rng.uniform(-1.5, 1.5, (300, 3))
    distances = compute_surface_distances(points, corners, np.array([[0, 1, 2]]))
    expected = [distance_by_least_squares(point, corners) for point in points]
    np.testing.assert_allclose(distances, expected, atol=1e-5)


def test_the_nearest_of_many_triangles_is_found(rng):
    model = tube()
    points = rng.uniform([-0.02, -0.03, -0.03], [0.11, 0.03, 0.03], (200, 3))
    together = compute_surface_distances(points, model.vertices, model.faces)
    single = np.min([compute_surface_distances(points, model.vertices, face[None]) for face in model.faces], axis=0)
    np.testing.assert_array_equal(together, single)


def test_points_on_the_surface_have_no_distance(rng):
    model = tube()
    corners = model.vertices[model.faces]
    shares = rng.dirichlet([1, 1, 1], len(corners))
    points = np.einsum("fk,fkx->fx", shares, corners)
    assert compute_surface_distances(points, model.vertices, model.faces).max() < 1e-9


def test_a_degenerate_triangle_counts_as_the_line_or_point_it_is():
    point = np.array([[0.0, 0.0, 1.0]])
    on_a_line = np.array([[-1.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]])
    assert compute_surface_distances(point, on_a_line, np.array([[0, 1, 2]]))[0] == pytest.approx(1.0)
    assert compute_surface_distances(point, np.zeros((1, 3)), np.array([[0, 0, 0]]))[0] == pytest.approx(1.0)

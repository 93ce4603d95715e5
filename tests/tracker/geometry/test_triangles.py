"""Triangle kernels against other ways to the same answer."""

import numpy as np
import pytest
from trimesh.triangles import closest_point

from tracker.geometry.triangles import do_triangles_cross, find_closest, meet_line

PAIR = np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int32)


def does_edge_pierce(p, q, triangle):
    """Whether the segment p q meets a triangle: solve p + t (q − p) = a + β u + γ w."""
    a, u, w = triangle[0], triangle[1] - triangle[0], triangle[2] - triangle[0]
    matrix = np.stack([u, w, p - q], axis=1)
    if abs(np.linalg.det(matrix)) < 1e-14:
        return False
    beta, gamma, t = np.linalg.solve(matrix, p - a)
    return beta >= 0 and gamma >= 0 and beta + gamma <= 1 and 0 <= t <= 1


def does_any_edge_pierce(points):
    first, second = points[:3], points[3:]
    return any(
        does_edge_pierce(one[i], one[(i + 1) % 3], other)
        for one, other in ((first, second), (second, first))
        for i in range(3)
    )


def test_triangles_cross_exactly_when_an_edge_of_one_pierces_the_other(rng):
    answers = []
    for _ in range(1000):
        points = rng.normal(size=(6, 3))
        points[3:] += rng.normal(size=3)
        answers.append(does_any_edge_pierce(points))
        assert do_triangles_cross(points, PAIR, 0, 1) == do_triangles_cross(points, PAIR, 1, 0) == answers[-1]
    assert 100 < sum(answers) < 900


def test_crossing_does_not_depend_on_the_unit_or_the_place(rng):
    for _ in range(200):
        points = rng.normal(size=(6, 3))
        answer = do_triangles_cross(points, PAIR, 0, 1)
        assert do_triangles_cross(0.001 * points, PAIR, 0, 1) == answer
        assert do_triangles_cross(points + 10.0, PAIR, 0, 1) == answer


def test_triangles_in_one_plane_or_without_area_do_not_cross():
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.1, 0.1, 0], [1.1, 0.1, 0], [0.1, 1.1, 0]], dtype=float)
    assert not do_triangles_cross(flat, PAIR, 0, 1)
    sliver = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, -1], [0.2, 0.2, 1], [0.2, 0.2, 1]], dtype=float)
    assert not do_triangles_cross(sliver, PAIR, 0, 1)


@pytest.mark.parametrize("corner", range(3))
def test_touching_with_a_corner_counts_as_crossing(corner):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 0], [0.2, 0.3, 1], [0.3, 0.2, 1]], dtype=float)
    points[3:] = np.roll(points[3:], corner, axis=0)
    assert do_triangles_cross(points, PAIR, 0, 1)


def test_a_line_meets_a_triangle_where_its_plane_says(rng):
    hits = 0
    for _ in range(500):
        points = rng.normal(size=(3, 3))
        start, direction = rng.normal(size=3), rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        along, cosine = meet_line(points, PAIR, 0, *start, *direction)
        far = np.array([start - 100 * direction, start + 100 * direction])
        assert (cosine != 0.0) == does_edge_pierce(*far, points)
        if cosine != 0.0:
            hits += 1
            normal = np.cross(points[1] - points[0], points[2] - points[0])
            normal /= np.linalg.norm(normal)
            assert cosine == pytest.approx(normal @ direction)
            assert normal @ (start + along * direction - points[0]) == pytest.approx(0.0, abs=1e-9)
    assert hits > 20


def test_distance_to_a_triangle_is_the_distance_to_its_closest_point(rng):
    for _ in range(500):
        points, query = rng.normal(size=(3, 3)), rng.normal(size=3) * 2
        closest = closest_point(points[None], query[None])[0]
        squared, b, c = find_closest(*query, points, 0, 1, 2)
        assert np.sqrt(squared) == pytest.approx(np.linalg.norm(closest - query), abs=1e-9)
        assert np.array([1.0 - b - c, b, c]) @ points == pytest.approx(closest, abs=1e-9)


def test_distance_to_a_triangle_without_area_is_that_to_its_longest_side():
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, 0]], dtype=float)
    assert find_closest(0.5, 2.0, 0.0, points, 0, 1, 2)[0] == pytest.approx(4.0)

"""Closest points against looking at every triangle.

Offsets are from the curved triangle, heights above the flat one.
"""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.untrained_hand import untrained_hand
from tracker.registration.surface_search import SurfaceSearch


def find_all_closest(points, vertices, faces):
    """(N, F) distances of every point from every triangle, by projecting onto plane, edges and corners in turn."""
    a, b, c = (vertices[faces[:, k]][None] for k in range(3))
    p = points[:, None]
    normal = np.cross(b - a, c - a)
    normal = normal / np.linalg.norm(normal, axis=2, keepdims=True)
    height = np.sum((p - a) * normal, axis=2)
    foot = p - height[:, :, None] * normal
    inside = np.ones(height.shape, dtype=bool)
    distances = np.full(height.shape, np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        edge = end - start
        inside &= np.sum(np.cross(edge, foot - start) * normal, axis=2) >= 0.0
        share = np.clip(np.sum((p - start) * edge, axis=2) / np.sum(edge * edge, axis=2), 0.0, 1.0)
        distances = np.minimum(distances, np.linalg.norm(p - start - share[:, :, None] * edge, axis=2))
    return np.where(inside, np.abs(height), distances), normal[0]


@pytest.fixture(scope="module")
def problem():
    hand = untrained_hand()
    rng = np.random.default_rng(1)
    ids = rng.integers(0, len(hand.template), 300)
    points = hand.template[ids] + rng.normal(scale=0.006, size=(300, 3))
    normals = rng.normal(size=(300, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    search = SurfaceSearch(hand.template, hand.faces)
    return hand, search, points, normals, find_all_closest(points, hand.template, hand.faces)


def test_without_normals_every_point_finds_the_nearest_of_all_triangles(problem):
    hand, search, points, normals, (distances, _) = problem
    found = search.match(hand.template, points, np.zeros_like(normals), reach=1.0)
    assert np.abs(found.offsets + found.heights) == pytest.approx(distances.min(axis=1), abs=1e-12)


def test_with_normals_it_finds_the_nearest_of_those_that_look_the_same_way(problem):
    hand, search, points, normals, (distances, face_normals) = problem
    found = search.match(hand.template, points, normals, reach=1.0)
    allowed = np.where(normals @ face_normals.T > 0.25, distances, np.inf)
    assert np.abs(found.offsets + found.heights) == pytest.approx(allowed.min(axis=1), abs=1e-12)


def test_seeds_change_nothing_but_the_time(problem):
    hand, search, points, normals, _ = problem
    plain = search.match(hand.template, points, normals, reach=1.0)
    seeds = np.random.default_rng(2).integers(-1, len(hand.faces), len(points)).astype(np.int32)
    seeded = search.match(hand.template, points, normals, reach=1.0, seeds=seeds)
    assert np.abs(seeded.offsets) == pytest.approx(np.abs(plain.offsets), abs=1e-15)


def test_nothing_is_found_beyond_the_reach(problem):
    hand, search, points, normals, (distances, _) = problem
    found = search.match(hand.template, points, np.zeros_like(normals), reach=0.004)
    assert np.array_equal(found.faces < 0, distances.min(axis=1) >= 0.004)


def test_point_direction_and_offset_lead_back_to_the_closest_point(problem):
    hand, search, points, normals, _ = problem
    found = search.match(hand.template, points, np.zeros_like(normals), reach=1.0)
    closest = np.einsum("nk,nkd->nd", found.weights, hand.template[search.faces[found.faces]])
    assert closest + (found.offsets + found.heights)[:, None] * found.directions == pytest.approx(points, abs=1e-9)


def test_points_behind_the_wrist_lie_on_the_rim_and_others_do_not():
    hand = untrained_hand()
    search = SurfaceSearch(hand.template, hand.faces)
    behind = hand.template[search.is_rim_vertex].mean(axis=0) - np.array([[0.03, 0.0, 0.0]])
    tips = hand.template[hand.tips] * 1.02
    found = search.match(hand.template, np.concatenate([behind, tips]), np.zeros((6, 3)), reach=1.0)
    assert found.on_rim.tolist() == [True, False, False, False, False, False]

"""A coarse mesh whose triangles bulge lies on the round thing it was made of."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.curved_triangles import find_bulges, find_middles, refine
from tracker.registration.surface_search import SurfaceSearch
from tracker.synthesis.scans.generate import ScanOptions, generate_truth
from tracker.synthesis.scans.tissue import vertex_normals

HAND = untrained_hand()
FACES = HAND.faces.astype(np.int64)


def test_bulges_are_those_of_plain_numpy():
    normals = find_unit_normals(HAND.template, FACES)
    i, j = FACES, np.roll(FACES, -1, axis=1)
    chords = HAND.template[j] - HAND.template[i]
    first = chords - np.einsum("fkd,fkd->fk", chords, normals[i])[..., None] * normals[i]
    last = chords - np.einsum("fkd,fkd->fk", chords, normals[j])[..., None] * normals[j]
    assert find_bulges(HAND.template, FACES) == pytest.approx((first - last) / 8.0, abs=1e-15)


def test_neighbours_agree_on_the_curve_of_the_edge_they_share():
    bulges = find_bulges(HAND.template, FACES)
    seen = {}
    for face, mine in zip(FACES, bulges, strict=True):
        for k in range(3):
            edge = tuple(sorted((face[k], face[(k + 1) % 3])))
            assert mine[k] == pytest.approx(seen.setdefault(edge, mine[k]), abs=1e-15)


def test_a_flat_sheet_stays_flat():
    grid = np.stack(np.meshgrid(range(5), range(5)), axis=-1).reshape(-1, 2).astype(float)
    vertices = np.column_stack([grid, np.zeros(25)])
    corners = np.array([[n, n + 1, n + 5] for n in range(20) if n % 5 < 4])
    faces = np.concatenate([corners, np.column_stack([corners[:, 2], corners[:, 1], corners[:, 2] + 1])])
    assert find_bulges(vertices, faces) == pytest.approx(0.0, abs=1e-15)


@settings(max_examples=25)
@given(seed=st.integers(0, 10_000), size=st.floats(0.1, 10.0))
def test_a_hand_that_is_turned_moved_and_scaled_bulges_alike(seed, size):
    rng = np.random.default_rng(seed)
    R, t = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    expected = size * find_bulges(HAND.template, FACES) @ R.T
    assert find_bulges(size * HAND.template @ R.T + t, FACES) == pytest.approx(expected, abs=1e-12)


def test_points_of_a_ball_are_a_twentieth_as_far_from_curved_triangles_as_from_flat_ones():
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.01)  # edges of 3 mm, about those of a fingertip
    points = trimesh.creation.icosphere(subdivisions=5, radius=0.01).vertices
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.faces)
    found = SurfaceSearch(vertices, faces).match(vertices, np.array(points), np.zeros(points.shape), reach=1.0)
    assert np.abs(found.offsets).mean() < np.abs(found.offsets + found.heights).mean() / 20.0
    assert np.linalg.norm(find_middles(vertices, faces), axis=1) == pytest.approx(0.01, rel=0.01)


def test_true_vertices_of_a_hand_span_its_skin_when_triangles_are_curved():
    truth = generate_truth(1, "relaxed", "right", 0, ScanOptions())
    normals = vertex_normals(truth.surface, truth.surface_faces)
    search = SurfaceSearch(truth.vertices, FACES)
    found = search.match(truth.vertices, truth.surface, normals, reach=0.005)
    counted = (found.faces >= 0) & ~found.on_rim
    flat, curved = (1e3 * np.abs(d[counted]).mean() for d in (found.offsets + found.heights, found.offsets))
    assert curved < 0.4 * flat


def test_a_refined_mesh_keeps_its_vertices_has_no_cracks_and_lies_on_the_curved_one():
    vertices, faces = refine(HAND.template, FACES)
    assert np.array_equal(vertices[: len(HAND.template)], HAND.template) and len(faces) == 16 * len(FACES)
    before, after = (trimesh.Trimesh(*mesh, process=False) for mesh in ((HAND.template, FACES), (vertices, faces)))
    assert after.euler_number == before.euler_number and after.is_winding_consistent
    assert len(after.outline().entities) == len(before.outline().entities) == 1
    search = SurfaceSearch(HAND.template, FACES)
    found = search.match(HAND.template, vertices, vertex_normals(vertices, faces), reach=0.005)
    inner = (found.faces >= 0) & ~found.on_rim
    assert 1e3 * np.percentile(np.abs(found.offsets[inner]), 95) < 0.1


def test_a_refined_ball_is_round():
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.01)
    vertices, _ = refine(np.asarray(ball.vertices), np.asarray(ball.faces))
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(0.01, rel=0.005)

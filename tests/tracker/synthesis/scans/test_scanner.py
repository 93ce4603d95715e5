"""A scanner sees what faces it and nothing hides, evenly, with the noise that was asked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.synthesis.scans.scanner import LEAST_COSINE, Scanner, _draw, face_areas, place_heads, scan_surface

SCANNER = Scanner(num_points=4000, pixels=300, holes=(0, 0))
BALL = trimesh.creation.icosphere(subdivisions=4, radius=0.05)
VERTICES, FACES = np.asarray(BALL.vertices), np.asarray(BALL.faces, dtype=np.int64)
ALL = np.ones(len(FACES), dtype=bool)


def scan(scanner: Scanner = SCANNER, seed: int = 0, vertices=VERTICES, faces=FACES, kept=ALL):
    return scan_surface(vertices, faces, kept, scanner, np.random.default_rng(seed))


def test_points_err_along_the_normal_by_the_noise_and_normals_by_theirs() -> None:
    found = scan(replace(SCANNER, noise=1e-3, normal_noise_deg=5.0, num_points=8000))
    radius = np.linalg.norm(found.points, axis=1)
    assert np.std(radius) == pytest.approx(1e-3, rel=0.05) and abs(radius.mean() - 0.05) < 1e-4
    apart = np.degrees(np.arccos(np.einsum("nx,nx->n", found.normals, found.points) / radius))
    assert np.sqrt(np.mean(apart**2)) == pytest.approx(5.0 * np.sqrt(2.0), rel=0.05), "about each of two axes"


def test_a_ball_is_seen_all_around_and_evenly() -> None:
    found = scan(replace(SCANNER, num_points=20_000))
    octant = (found.points > 0).astype(int) @ [1, 2, 4]
    counts = np.bincount(octant, minlength=8)
    assert counts.min() > 0.75 * counts.max()


def test_no_point_is_seen_flatter_than_any_head_can() -> None:
    heads = place_heads(VERTICES, SCANNER, np.random.default_rng(0))
    found = scan(replace(SCANNER, noise=0.0))
    normal = BALL.face_normals[found.faces]
    towards = np.array([head.center for head in heads])[:, None] - found.points
    cosine = np.einsum("hnx,nx->hn", towards, normal) / np.linalg.norm(towards, axis=2)
    assert (cosine.max(axis=0) > LEAST_COSINE).all()


def test_what_stands_inside_another_thing_gives_no_points() -> None:
    vertices, faces = np.vstack([VERTICES, 0.5 * VERTICES]), np.vstack([FACES, FACES + len(VERTICES)])
    found = scan(vertices=vertices, faces=faces, kept=np.ones(len(faces), dtype=bool))
    assert np.mean(found.faces < len(FACES)) > 0.999


def test_what_is_not_kept_gives_no_points_and_hides_others_all_the_same() -> None:
    upper = BALL.triangles_center[:, 2] > 0
    assert set(np.unique(upper[scan(kept=upper).faces])) == {True}
    vertices, faces = np.vstack([VERTICES, 0.5 * VERTICES]), np.vstack([FACES, FACES + len(VERTICES)])
    inner = np.arange(len(faces)) >= len(FACES)
    found = scan(vertices=vertices, faces=faces, kept=inner)
    assert len(found.points) < 1e-3 * 40 * SCANNER.num_points, "of all draws"


def test_holes_have_no_points_in_them_and_the_same_seed_the_same_holes() -> None:
    holed = replace(SCANNER, holes=(3, 3), hole_radius=(8e-3, 8e-3), noise=0.0)
    first, again, other = scan(holed, 1), scan(holed, 1), scan(holed, 2)
    assert np.array_equal(first.points, again.points) and not np.array_equal(first.points, other.points)
    whole = scan(replace(holed, holes=(0, 0)), 1).points
    gaps = np.array([np.linalg.norm(first.points - point, axis=1).min() for point in whole])
    assert 5e-3 < gaps.max() < 9e-3, "m; the middle of a hole is about its radius from the next point"


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_points_are_drawn_inside_their_faces_and_faces_by_their_area(seed) -> None:
    rng = np.random.default_rng(seed)
    vertices = rng.standard_normal((6, 3))
    faces = np.array([[0, 1, 2], [3, 4, 5]])
    areas, _ = face_areas(vertices, faces)
    face, points, shares = _draw(vertices, faces, areas, 4000, rng)
    assert shares.min() >= 0.0 and np.allclose(shares.sum(axis=1), 1.0)
    assert np.allclose(points, np.einsum("nk,nkx->nx", shares, vertices[faces[face]]))
    assert np.mean(face == 0) == pytest.approx(areas[0] / areas.sum(), abs=0.05)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_heads_stand_around_what_they_look_at_and_have_all_of_it_in_their_pictures(seed) -> None:
    rng = np.random.default_rng(seed)
    vertices = rng.standard_normal((40, 3)) * rng.uniform(0.02, 0.1, 3) + rng.standard_normal(3)
    for head in place_heads(vertices, Scanner(), rng):
        assert np.allclose(head.R @ head.R.T, np.eye(3), atol=1e-9) and np.linalg.det(head.R) > 0
        local = (vertices - head.center) @ head.R.T
        pixels = head.K[0, 0] * local[:, :2] / local[:, 2:] + head.K[0, 2]
        assert local[:, 2].min() > 0.0 and pixels.min() > 0.0 and pixels.max() < head.pixels - 1

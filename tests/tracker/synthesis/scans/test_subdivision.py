"""Loop's scheme keeps what is flat flat, closed meshes closed, and borders their own."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.synthesis.scans.subdivision import subdivide
from tracker.synthesis.scans.subject import find_border
from tracker.synthesis.scans.ties import border_vertices

SPHERE = trimesh.creation.icosphere(subdivisions=1)
CLOSED = np.asarray(SPHERE.faces, dtype=np.int64)


def grid(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 2) of a flat patch and its faces."""
    y, x = (values.ravel() for values in np.mgrid[:rows, :columns])
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    lower = np.stack([corner, corner + 1, corner + columns], axis=1)
    upper = np.stack([corner + 1, corner + columns + 1, corner + columns], axis=1)
    return np.column_stack([x, y]).astype(np.float64), np.concatenate([lower, upper])


@settings(max_examples=30, deadline=None)
@given(st.integers(2, 7), st.integers(2, 7))
def test_faces_become_four_each_edge_a_vertex_and_every_vertex_a_mean(rows, columns) -> None:
    vertices, faces = grid(rows, columns)
    step = subdivide(faces, len(vertices))
    edges = len(np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0))
    assert step.faces.shape == (4 * len(faces), 3) and step.size == len(vertices) + edges == step.matrix.shape[0]
    assert np.allclose(np.asarray(step.matrix.sum(axis=1)), 1.0) and step.matrix.min() >= 0.0


@settings(max_examples=30, deadline=None)
@given(st.integers(3, 7), st.integers(3, 7), st.lists(st.floats(-2, 2), min_size=2, max_size=2))
def test_a_slope_over_a_regular_patch_stays_that_slope_inside(rows, columns, slope) -> None:
    vertices, faces = grid(rows, columns)
    step = subdivide(faces, len(vertices))
    heights = vertices @ np.array(slope)
    placed, height = step.matrix @ vertices, step.matrix @ heights
    assert np.allclose(height, placed @ np.array(slope), atol=1e-12)
    inner = np.setdiff1d(np.arange(len(vertices)), border_vertices(faces))
    assert np.allclose(placed[inner], vertices[inner], atol=1e-12), "where the patch is regular nothing moves in it"


def test_a_closed_mesh_stays_closed_and_its_faces_look_out() -> None:
    step = subdivide(CLOSED, len(SPHERE.vertices))
    finer = trimesh.Trimesh(step.matrix @ SPHERE.vertices, step.faces, process=False)
    assert finer.is_watertight and finer.is_winding_consistent and 0.75 * SPHERE.volume < finer.volume < SPHERE.volume
    assert len(border_vertices(step.faces)) == 0


def test_a_border_is_made_of_the_border_alone() -> None:
    vertices, faces = grid(4, 5)
    step = subdivide(faces, len(vertices))
    rim, finer_rim = border_vertices(faces), border_vertices(step.faces)
    assert len(finer_rim) == 2 * len(rim)
    used = np.flatnonzero(np.asarray(step.matrix[finer_rim].sum(axis=0)).ravel())
    assert np.isin(used, rim).all()


def test_the_border_of_a_patch_is_one_loop_along_its_edges() -> None:
    _, faces = grid(4, 5)
    loop = find_border(faces)
    assert sorted(loop) == sorted(border_vertices(faces))
    known = {tuple(edge) for edge in faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).tolist()}
    assert all((b, a) in known for a, b in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True))


def test_an_edge_of_three_faces_is_no_surface() -> None:
    with pytest.raises(AssertionError, match="more than two faces"):
        subdivide(np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]), 5)

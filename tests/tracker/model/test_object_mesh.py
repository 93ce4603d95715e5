"""Whatever triangles a file holds become a mesh whose faces look outwards."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.geometry.triangles import is_watertight
from tracker.model.decimation import compute_volume
from tracker.model.object_mesh import clean_mesh


def ball(radius: float = 0.05, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(subdivisions=1, radius=radius)
    return np.array(mesh.vertices) + at, np.array(mesh.faces)


def join(*meshes: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + start for (_, faces), start in zip(meshes, starts, strict=False)]),
    )


def corners(vertices: np.ndarray, faces: np.ndarray) -> set:
    """Each face as its corners in turn, from the least of them, whatever the numbers of its vertices."""
    found = set()
    for face in np.round(vertices[faces], 9).tolist():
        points = [tuple(point) for point in face]
        first = points.index(min(points))
        found.add(tuple(points[first:] + points[:first]))
    return found


@settings(max_examples=12)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 1.0))
def test_however_faces_were_turned_they_all_look_outwards(seed, share):
    vertices, faces = ball(at=(0.3, -0.1, 0.2))
    is_turned = np.random.default_rng(seed).random(len(faces)) < share
    mesh = clean_mesh(vertices, np.where(is_turned[:, None], faces[:, ::-1], faces))
    assert is_watertight(mesh.faces) and mesh.open_edges == 0
    assert corners(mesh.vertices, mesh.faces) == corners(vertices, faces)


def test_a_mesh_that_is_inside_out_is_turned_and_a_clean_one_stays():
    vertices, faces = ball()
    for given_faces in (faces, faces[:, ::-1]):
        mesh = clean_mesh(vertices, given_faces)
        assert compute_volume(mesh.vertices, mesh.faces) == pytest.approx(compute_volume(vertices, faces))
        again = clean_mesh(mesh.vertices, mesh.faces)
        np.testing.assert_array_equal(again.vertices, mesh.vertices)
        np.testing.assert_array_equal(again.faces, mesh.faces)


def test_each_piece_is_turned_by_itself():
    one, other = ball(0.05), ball(0.02, (0.2, 0.0, 0.0))
    mesh = clean_mesh(*join((one[0], one[1][:, ::-1]), other))
    assert corners(mesh.vertices, mesh.faces) == corners(*join(one, other))


def test_split_vertices_become_one_and_unused_ones_go():
    """A soup of triangles, each with corners of its own, as STL has them."""
    vertices, faces = ball()
    soup = vertices[faces].reshape(-1, 3) + 1e-9 * np.random.default_rng(0).normal(size=(3 * len(faces), 3))
    mesh = clean_mesh(np.concatenate([soup, [[0.01, 0.0, 0.0]]]), np.arange(len(soup)).reshape(-1, 3))
    assert len(mesh.vertices) == len(vertices) and mesh.open_edges == 0
    assert set(np.unique(mesh.faces)) == set(range(len(vertices)))


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_what_counts_as_one_vertex_depends_on_the_size_of_the_mesh(scale):
    vertices, faces = ball(scale)
    for gap, is_split in ((1e-8, False), (1e-4, True)):
        moved = vertices.copy()
        moved[0] += gap * scale
        mesh = clean_mesh(np.concatenate([vertices, moved]), np.concatenate([faces, faces + len(vertices)]))
        assert (len(mesh.vertices) > len(vertices)) == is_split


def test_faces_without_area_and_doubles_are_dropped():
    vertices, faces = ball()
    bad = np.array([[0, 0, 1], [2, 2, 2]])
    middle = 0.5 * (vertices[faces[0, 0]] + vertices[faces[0, 1]])
    sliver = [[faces[0, 0], faces[0, 1], len(vertices)]]
    turned, twice = faces[3:5, ::-1], faces[7:9, [1, 2, 0]]
    mesh = clean_mesh(np.concatenate([vertices, [middle]]), np.concatenate([faces, bad, sliver, turned, twice]))
    assert corners(mesh.vertices, mesh.faces) == corners(vertices, faces)
    assert len(mesh.faces) == len(faces)


def test_a_hole_is_counted_by_its_edges_and_most_of_the_rest_looks_away_from_its_middle():
    vertices, faces = ball()
    kept = faces[vertices[faces].mean(axis=1)[:, 2] < 0.03]
    assert len(kept) < len(faces)
    rng = np.random.default_rng(1)
    mesh = clean_mesh(vertices, np.where(rng.random(len(kept))[:, None] < 0.5, kept[:, ::-1], kept))
    edges = np.sort(np.concatenate([kept[:, [0, 1]], kept[:, [1, 2]], kept[:, [2, 0]]]), axis=1)
    assert mesh.open_edges == np.sum(np.unique(edges, axis=0, return_counts=True)[1] == 1) > 3
    assert corners(mesh.vertices, mesh.faces) == corners(vertices, kept)


def test_an_edge_of_three_faces_is_open():
    vertices, faces = ball()
    fin = [[faces[0, 0], faces[0, 1], len(vertices)]]
    mesh = clean_mesh(np.concatenate([vertices, [[0.0, 0.0, 0.2]]]), np.concatenate([faces, fin]))
    assert mesh.open_edges == 3, "the shared one and the two of the fin"


def test_nothing_but_faces_without_area_leaves_nothing():
    mesh = clean_mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    assert (len(mesh.vertices), len(mesh.faces), mesh.open_edges) == (0, 0, 0)

"""Names of registered frames that a step done twice finds, and normals of their surfaces."""

from __future__ import annotations

import uuid

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from server.moving_scans.storing import compute_normals, name_frame


def test_a_frame_has_one_id_of_its_own_that_is_the_same_for_ever() -> None:
    """Rows and folders that are stored have it."""
    first, second = (uuid.UUID(int=number) for number in (1, 2))
    assert len({name_frame(registration, frame) for registration in (first, second) for frame in range(200)}) == 400
    assert name_frame(first, 7) == uuid.UUID("7645af19-24e0-5da9-ab6f-bf1311e193ee")


def make_ball(rng: np.random.Generator, count: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Points on the unit ball with faces that look outwards."""
    vertices = rng.normal(size=(count, 3))
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    faces = ConvexHull(vertices).simplices
    corners = vertices[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    is_inwards = np.einsum("fx,fx->f", across, corners[:, 0])
    faces[is_inwards < 0] = faces[is_inwards < 0][:, ::-1]
    return vertices, faces


def test_normals_of_a_ball_point_away_from_its_middle(rng: np.random.Generator) -> None:
    vertices, faces = make_ball(rng, 1500)
    normals = compute_normals(vertices, faces)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12)
    assert np.einsum("vx,vx->v", normals, vertices).min() > 0.99


def test_each_normal_is_the_mean_of_its_faces_by_their_areas(rng: np.random.Generator) -> None:
    vertices, faces = rng.normal(size=(9, 3)), np.array([[0, 1, 2], [0, 2, 3], [0, 4, 1], [5, 6, 7]])
    found = compute_normals(vertices, faces)
    for vertex in range(8):
        total = np.zeros(3)
        for a, b, c in faces[(faces == vertex).any(axis=1)]:
            across = np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])
            area = 0.5 * np.linalg.norm(across)
            total += area * across / np.linalg.norm(across)
        np.testing.assert_allclose(found[vertex], total / np.linalg.norm(total), atol=1e-12)
    np.testing.assert_array_equal(found[8], 0.0, "a vertex of no face has none")


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_normals_turn_with_the_surface_and_do_not_know_its_size(rng: np.random.Generator, scale: float) -> None:
    vertices, faces = make_ball(rng, 60)
    turn = Rotation.from_rotvec(rng.normal(size=3)).as_matrix()
    moved = scale * vertices @ turn.T + rng.normal(size=3)
    np.testing.assert_allclose(compute_normals(moved, faces), compute_normals(vertices, faces) @ turn.T, atol=1e-9)


def test_a_face_without_an_area_turns_no_normal() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]])
    flat, with_empty = np.array([[0, 1, 2]]), np.array([[0, 1, 2], [0, 1, 3]])
    np.testing.assert_array_equal(compute_normals(vertices, flat)[:3], compute_normals(vertices, with_empty)[:3])
    np.testing.assert_array_equal(compute_normals(vertices, flat)[0], [0.0, 0.0, 1.0])

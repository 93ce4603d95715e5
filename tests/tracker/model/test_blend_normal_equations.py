"""Summed blocks give the normal equations that the rows themselves give."""

from __future__ import annotations

import numpy as np

from tests.tracker.random_blend import random_blend, random_pose
from tracker.model.blend_normal_equations import MeshEdges, plane_system, vertex_system


def scattered(model, posed, count, rng):
    """Points near the posed surface, with face, place on it, normal and weight."""
    ids = rng.integers(0, len(model.faces), count)
    barycentric = rng.dirichlet(np.ones(3), count)
    on = np.einsum("nk,nkx->nx", barycentric, posed.vertices[model.faces[ids]])
    normals = rng.standard_normal((count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return ids, barycentric, on + 0.002 * rng.standard_normal((count, 3)), normals, rng.uniform(0.0, 2.0, count)


def test_planes_give_what_their_rows_give(rng):
    model = random_blend()
    posed = model.pose_at(*random_pose(model))
    ids, barycentric, points, normals, weights = scattered(model, posed, 3000, rng)
    weights[:100] = 0.0
    system = plane_system(
        posed.vertices, model.faces, MeshEdges.of(model.faces), ids, barycentric, points, normals, weights
    )
    jacobian = posed.vertex_jacobian()
    JtJ, Jtr = system.by_parameters(jacobian)
    rows = np.einsum("nk,nx,nkxp->np", barycentric, normals, jacobian[model.faces[ids]])
    on = np.einsum("nk,nkx->nx", barycentric, posed.vertices[model.faces[ids]])
    residual = np.einsum("nx,nx->n", normals, on - points)
    np.testing.assert_allclose(JtJ, (weights[:, None] * rows).T @ rows, atol=1e-9)
    np.testing.assert_allclose(Jtr, rows.T @ (weights * residual), atol=1e-10)
    np.testing.assert_allclose(system.cost, weights @ residual**2)


def test_blocks_are_those_of_the_free_surface(rng):
    model = random_blend()
    posed = model.pose_at()
    ids, barycentric, points, normals, weights = scattered(model, posed, 500, rng)
    edges = MeshEdges.of(model.faces)
    system = plane_system(posed.vertices, model.faces, edges, ids, barycentric, points, normals, weights)
    free = np.eye(3 * len(model.template)).reshape(len(model.template), 3, -1)
    A, _ = system.by_parameters(free)
    rows = np.zeros((500, len(model.template), 3))
    for k in range(3):
        rows[np.arange(500), model.faces[ids, k]] += barycentric[:, k, None] * normals
    rows = rows.reshape(500, -1)
    np.testing.assert_allclose(A, (weights[:, None] * rows).T @ rows, atol=1e-12)


def test_every_edge_of_a_face_joins_its_corners():
    faces = random_blend().faces
    edges = MeshEdges.of(faces)
    for corner in range(3):
        pair = np.sort(np.stack([faces[:, corner], faces[:, (corner + 1) % 3]], axis=1), axis=1)
        np.testing.assert_array_equal(edges.ends[edges.of_faces[:, corner]], pair)


def test_vertex_targets_are_reached_by_gauss_newton(rng):
    model = random_blend()
    pose, shape, translation = random_pose(model)
    target = model.pose_at(pose, shape, translation).vertices
    found = model.retract(pose, shape, translation, 0.05 * rng.standard_normal(model.num_parameters))
    for _ in range(12):
        posed = model.pose_at(*found)
        JtJ, Jtr, cost = vertex_system(posed, target, np.ones(len(target)), posed.vertex_jacobian())
        np.testing.assert_allclose(cost, np.sum((posed.vertices - target) ** 2))
        found = model.retract(*found, -np.linalg.solve(JtJ + 1e-9 * np.eye(len(Jtr)), Jtr))
    assert np.abs(model.pose_at(*found).vertices - target).max() < 1e-9

"""Decimation with everything that hangs on the vertices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tracker.errors import TrackerError
from tracker.geometry.triangles import is_watertight
from tracker.model import MAX_WEIGHTS, ArticulatedModel, Scene, decimate, load_t16_model, with_shape
from tracker.model.decimation import (
    closest_on_triangles,
    compute_volume,
    find_surface_points,
    limit_weights,
    simplify,
)
from tracker.model.default_hand import default_hand


@pytest.fixture(scope="module")
def full(shared_data: Path) -> ArticulatedModel:
    return load_t16_model(shared_data / "ijcv16" / "models" / "Model_Hand_R.OFF", max_faces=None)


def surface_distances(points: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    return np.linalg.norm(find_surface_points(points, vertices, faces, 16).interpolate(vertices) - points, axis=1)


@pytest.mark.shared_data
@pytest.mark.parametrize("max_faces", [600, 1500, 4000])
def test_the_count_is_reached_and_the_mesh_stays_closed_with_its_volume(full: ArticulatedModel, max_faces: int) -> None:
    model = decimate(full, max_faces)
    assert 0.9 * max_faces <= len(model.faces) <= 1.02 * max_faces
    assert is_watertight(full.faces) and is_watertight(model.faces)
    volume = compute_volume(full.vertices, full.faces)
    assert abs(compute_volume(model.vertices, model.faces) / volume - 1.0) < 0.01


@pytest.mark.shared_data
def test_weights_sum_to_one_over_few_bones(full: ArticulatedModel) -> None:
    weights = decimate(full, 1500).skinning_weights
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-12)
    assert weights.min() >= 0.0 and np.sum(weights > 0.0, axis=1).max() <= MAX_WEIGHTS


@pytest.mark.shared_data
def test_the_decimated_hand_moves_as_the_full_one(full: ArticulatedModel, rng: np.random.Generator) -> None:
    model = decimate(full, 1500)
    used = np.unique(model.faces)
    for _ in range(2):
        pose = np.r_[np.zeros(6), rng.uniform(0.5 * full.skeleton.lower, 0.5 * full.skeleton.upper)]
        posed, full_posed = Scene((model,)).pose_at(pose), Scene((full,)).pose_at(pose)
        vertices = posed.vertices[: len(model.vertices)]
        distances = surface_distances(vertices[used], full_posed.vertices[: len(full.vertices)], full.faces)
        assert np.mean(distances) < 4e-4 and np.max(distances) < 4e-3
        np.testing.assert_allclose(posed.landmarks(0), full_posed.landmarks(0), atol=1e-9)


def test_a_model_with_few_faces_is_left_alone() -> None:
    model = default_hand("right")
    assert decimate(model, 2000) is model


def test_landmarks_and_the_shape_basis_go_along() -> None:
    model = default_hand("right")
    small = decimate(model, 700)
    assert small.hand is not None and model.hand is not None and small.shape is not None and model.shape is not None
    betas = np.linspace(-1.5, 1.5, len(model.shape.names))
    for one, other in ((small, model), (with_shape(small, betas), with_shape(model, betas))):
        joints = [Scene((m,)).pose_at(np.zeros(37)).landmarks(0) for m in (one, other)]
        np.testing.assert_allclose(joints[0], joints[1], atol=1e-12)
    shaped, expected = with_shape(small, betas), with_shape(model, betas)
    used = np.unique(small.faces)
    assert np.mean(surface_distances(shaped.vertices[used], expected.vertices, expected.faces)) < 5e-4
    for ids in (*small.hand.fingertips, *small.hand.finger_parts.values()):
        assert set(ids.tolist()) <= set(used.tolist())


def test_a_mesh_that_cannot_be_reduced_says_so() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    with pytest.raises(TrackerError, match="stopped at 0"):
        simplify(corners, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]), 1)


def test_the_nearest_point_of_a_triangle_is_nearer_than_any_other(rng: np.random.Generator) -> None:
    triangles = rng.normal(size=(50, 3, 3))
    point = rng.normal(size=3)
    best = closest_on_triangles(point, triangles)
    assert best.min() >= 0.0
    np.testing.assert_allclose(best.sum(axis=1), 1.0, atol=1e-9)
    distance = np.linalg.norm(np.einsum("fk,fkx->fx", best, triangles) - point, axis=1)
    for _ in range(200):
        shares = rng.dirichlet([0.5, 0.5, 0.5], size=50)
        other = np.linalg.norm(np.einsum("fk,fkx->fx", shares, triangles) - point, axis=1)
        assert np.all(distance <= other + 1e-9)


def test_the_heaviest_weights_are_kept() -> None:
    weights = limit_weights(np.array([[0.1, 0.3, 0.2, 0.15, 0.2, 0.05]]))
    np.testing.assert_allclose(weights, [[0.0, 0.3, 0.2, 0.15, 0.2, 0.0]] / np.float64(0.85))

import numpy as np
import pytest

from tracker.geometry.geodesics import compute_geodesics


def make_grid(width: int, height: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A flat sheet with its inner vertices moved about: vertices (V, 3), faces (F, 3)."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(width, dtype=float), np.arange(height, dtype=float))
    x[1:-1, 1:-1] += rng.uniform(-0.3, 0.3, (height - 2, width - 2))
    y[1:-1, 1:-1] += rng.uniform(-0.3, 0.3, (height - 2, width - 2))
    corners = (np.arange(height - 1)[:, None] * width + np.arange(width - 1)).ravel()
    faces = np.concatenate(
        [
            np.stack([corners, corners + 1, corners + width + 1], axis=1),
            np.stack([corners, corners + width + 1, corners + width], axis=1),
        ]
    )
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1), faces


def test_on_a_flat_sheet_distances_are_straight():
    vertices, faces = make_grid(9, 7)
    sources = np.arange(0, len(vertices), 5)
    straight = np.linalg.norm(vertices[sources, None] - vertices, axis=2)
    np.testing.assert_allclose(compute_geodesics(vertices, faces, sources), straight, atol=1e-12)


def test_folding_a_sheet_changes_no_distance():
    vertices, faces = make_grid(9, 7)
    flat = np.linalg.norm(vertices[:, None] - vertices, axis=2)
    straight_column = np.isin(np.arange(len(vertices)) % 9, [4])
    vertices[straight_column, 0] = 4.0  # the fold runs along edges
    flat = np.linalg.norm(vertices[:, None] - vertices, axis=2)
    folded = vertices.copy()
    beyond = vertices[:, 0] > 4.0
    away = vertices[beyond, 0] - 4.0
    folded[beyond, 0], folded[beyond, 2] = 4.0 + away * np.cos(1.9), away * np.sin(1.9)
    np.testing.assert_allclose(compute_geodesics(folded, faces, np.arange(len(vertices))), flat, atol=1e-12)


def test_round_a_box_the_shorter_way_over_the_edge_is_found():
    """Opposite corners of a unit cube are √5 apart along its surface."""
    vertices = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))])
    distances = compute_geodesics(vertices, faces, np.array([0]))[0]
    assert distances[7] == pytest.approx(np.sqrt(5.0), abs=1e-12)
    assert distances[1] == pytest.approx(1.0) and distances[3] == pytest.approx(np.sqrt(2.0))


def test_paths_bend_round_a_hole():
    vertices, faces = make_grid(9, 7)
    middle = np.flatnonzero((np.abs(vertices[:, 0] - 4) < 1.5) & (np.abs(vertices[:, 1] - 3) < 1.5))
    kept = faces[~np.isin(faces, middle).any(1)]
    distances = compute_geodesics(vertices, kept, np.array([27]))[0]
    assert np.isinf(distances[middle]).all()
    others = np.setdiff1d(np.arange(len(vertices)), middle)
    assert np.isfinite(distances[others]).all()
    assert distances[35] > np.linalg.norm(vertices[35] - vertices[27]) + 0.1


def test_distances_are_symmetric_and_keep_the_triangle_inequality_on_a_bumpy_surface():
    vertices, faces = make_grid(8, 8, 1)
    vertices[:, 2] = np.random.default_rng(2).normal(0.0, 0.4, len(vertices))
    distances = compute_geodesics(vertices, faces, np.arange(len(vertices)))
    np.testing.assert_allclose(distances, distances.T, atol=1e-9)
    assert (distances[:, :, None] <= distances[:, None, :] + distances[None] + 1e-9).all()
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    assert (distances[edges[:, 0], edges[:, 1]] <= lengths + 1e-12).all()

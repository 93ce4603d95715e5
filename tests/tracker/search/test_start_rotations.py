"""Rotations to start from: spread evenly, and one of all that look the same."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from tests.tracker.search.drawn_objects import load_mesh
from tracker.search.start_rotations import propose_rotations, sample_surface, spread_rotations

ROTATIONS = spread_rotations(48)


def test_a_sphere_needs_one_rotation_and_a_lopsided_thing_many(tmp_path):
    counts = {}
    for name in ("ball", "box", "cone", "bracket"):
        model = load_mesh(tmp_path, name)
        rotations = propose_rotations(sample_surface(model.vertices, model.faces), spread_rotations(48))
        counts[name] = len(rotations)
        np.testing.assert_allclose(np.linalg.det(rotations), 1.0)
    assert counts["ball"] == 1
    assert counts["cone"] < counts["box"] <= counts["bracket"]


def test_rotations_are_spread_so_that_none_is_far_from_any():
    rotations = spread_rotations(48)
    rng = np.random.default_rng(0)
    q, _ = np.linalg.qr(rng.normal(size=(500, 3, 3)))
    q *= np.linalg.det(q)[:, None, None]
    traces = np.einsum("nij,mij->nm", q, rotations)
    nearest = np.degrees(np.arccos(np.clip((traces.max(axis=1) - 1.0) / 2.0, -1.0, 1.0)))
    assert nearest.max() < 70.0
    assert nearest.mean() < 38.0


def test_more_rotations_lie_closer_and_all_are_rotations() -> None:
    turns = Rotation.random(300, rng=np.random.default_rng(0)).as_matrix()
    farthest = []
    for count in (24, 96, 384):
        rotations = spread_rotations(count)
        assert rotations.shape == (count, 3, 3)
        np.testing.assert_allclose(np.linalg.det(rotations), 1.0)
        traces = np.einsum("nij,mij->nm", turns, rotations)
        farthest.append(np.degrees(np.arccos(np.clip((traces.max(axis=1) - 1.0) / 2.0, -1.0, 1.0))).max())
    assert farthest[0] > farthest[1] > farthest[2]
    assert farthest[2] < 40.0


def test_samples_lie_on_the_surface_as_dense_everywhere_and_are_the_same_every_time() -> None:
    box = trimesh.creation.box(extents=[0.1, 0.05, 0.02])
    vertices, faces = np.array(box.vertices), np.array(box.faces)
    points = sample_surface(vertices, faces, 2000)
    np.testing.assert_array_equal(points, sample_surface(vertices, faces, 2000))
    on = np.isclose(np.abs(points), [0.05, 0.025, 0.01], atol=1e-12)
    assert on.any(axis=1).all() and (np.abs(points) <= np.array([0.05, 0.025, 0.01]) + 1e-12).all()
    areas = np.array([0.05 * 0.02, 0.1 * 0.02, 0.1 * 0.05])
    np.testing.assert_allclose(on.mean(axis=0), areas / areas.sum(), atol=0.01)


def test_faces_without_area_get_no_samples() -> None:
    vertices = np.array([[0.0, 0, 0], [1.0, 0, 0], [0.0, 1.0, 0], [9.0, 9.0, 9.0]])
    points = sample_surface(vertices, np.array([[3, 3, 3], [0, 1, 2], [0, 3, 3]]), 50)
    assert points.shape == (50, 3)
    assert (points[:, 2] == 0.0).all() and (points[:, :2].sum(axis=1) <= 1.0 + 1e-12).all()


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_what_is_left_out_looks_like_one_that_is_kept_and_what_is_kept_like_no_other(scale: float) -> None:
    mesh = trimesh.creation.cylinder(radius=0.02, height=0.12, sections=24)
    points = scale * sample_surface(np.array(mesh.vertices), np.array(mesh.faces))
    kept = propose_rotations(points, ROTATIONS)
    assert 1 < len(kept) < len(ROTATIONS)
    np.testing.assert_array_equal(kept[0], ROTATIONS[0])
    axes = kept[:, :, 2]
    between = np.degrees(np.arccos(np.clip(np.abs(axes @ axes.T), 0.0, 1.0)))[np.triu_indices(len(kept), 1)]
    assert between.min() > 5.0, "turned about its axis or end to end a rod is the same"
    nearest = np.degrees(np.arccos(np.clip(np.abs(ROTATIONS[:, :, 2] @ axes.T), 0.0, 1.0))).min(axis=1)
    assert nearest.max() < 35.0


def test_one_rotation_is_proposed_as_it_is() -> None:
    points = np.random.default_rng(1).normal(size=(50, 3))
    np.testing.assert_array_equal(propose_rotations(points, ROTATIONS[5:6]), ROTATIONS[5:6])

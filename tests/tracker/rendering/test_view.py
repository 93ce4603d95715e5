"""A view is the z-buffer of its scene from where the camera stands, with every normal looking out of the surface."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.toys import tube
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.rendering import render_depth, render_view

K = np.array([[120.0, 0.0, 31.5], [0.0, 110.0, 23.5], [0.0, 0.0, 1.0]])
twists = st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6).map(np.array)


@pytest.fixture(scope="module")
def posed():
    scene = Scene((tube(),))
    pose = scene.rest_pose()
    pose[:3] = [-0.03, 0.0, 0.25]
    return scene.pose_at(pose)


@settings(max_examples=25, deadline=None)
@given(twists)
def test_a_camera_that_moves_with_the_scene_sees_the_same(twist) -> None:
    scene = Scene((tube(),))
    pose = scene.rest_pose()
    pose[:3] = [-0.03, 0.0, 0.25]
    still = scene.pose_at(pose)
    T = se3.exp(twist)
    moved = still.vertices @ T[:3, :3].T + T[:3, 3]
    seen = render_view(still, K, np.eye(4), 48, 64)
    other = render_depth(se3.transform(se3.inverse(T), moved), scene.arrays.faces, K, 64, 48)
    assert np.count_nonzero((seen.face >= 0) != (other.face >= 0)) <= 2, "rounding at the rim"
    both = (seen.face >= 0) & (other.face >= 0)
    assert np.allclose(seen.depth[both], other.depth[both], atol=1e-9)


def test_what_is_seen_are_faces_that_look_at_the_camera_with_unit_normals(posed) -> None:
    view = render_view(posed, K, np.eye(4), 48, 64)
    shown = np.unique(view.face[view.face >= 0])
    assert len(shown) > 10
    normals, middles = view.face_normals[shown], posed.vertices[posed.scene.arrays.faces[shown]].mean(axis=1)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert np.einsum("fx,fx->f", normals, middles).max() < 0.0, "the camera is at the origin"


def test_normals_are_the_cross_products_of_the_sides(posed) -> None:
    view = render_view(posed, K, np.eye(4), 48, 64)
    a, b, c = (posed.vertices[posed.scene.arrays.faces[:, corner]] for corner in range(3))
    cross = np.cross(b - a, c - a)
    assert np.allclose(view.face_normals, cross / np.linalg.norm(cross, axis=1, keepdims=True), atol=1e-12)


def test_projected_vertices_have_the_cameras_columns_and_rows_and_inverse_depth() -> None:
    scene = Scene((default_hand("right"),))
    pose = scene.rest_pose()
    pose[:3] = [0.0, 0.0, 0.4]
    posed = scene.pose_at(pose)
    T_world_camera = se3.exp(np.array([0.05, -0.02, 0.0, 0.1, 0.2, -0.1]))
    view = render_view(posed, K, T_world_camera, 48, 64)
    camera = se3.transform(se3.inverse(T_world_camera), posed.vertices)
    assert np.allclose(view.projected[:, :2], (camera @ K.T)[:, :2] / camera[:, 2:], atol=1e-9)
    assert np.allclose(view.projected[:, 2] * camera[:, 2], 1.0)


def test_what_is_behind_the_camera_is_not_drawn(posed) -> None:
    turned = np.diag([-1.0, 1.0, -1.0, 1.0])
    view = render_view(posed, K, turned, 48, 64)
    assert (view.face == -1).all() and not view.depth.any() and not view.projected.any()

"""The z-buffer draws what a ray would hit."""

import numpy as np

from tests.tracker.toys import tube
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.rendering import render_depth, render_view

K = np.array([[100.0, 0.0, 31.5], [0.0, 100.0, 23.5], [0.0, 0.0, 1.0]])


def cast_rays(vertices, faces, width, height):
    """Nearest hit of every pixel's ray, by Möller-Trumbore for all faces at once."""
    depth = np.zeros((height, width))
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    for row in range(height):
        for column in range(width):
            ray = np.array([(column - K[0, 2]) / K[0, 0], (row - K[1, 2]) / K[1, 1], 1.0])
            p = np.cross(ray, c - a)
            determinant = np.einsum("fi,fi->f", b - a, p)
            with np.errstate(divide="ignore", invalid="ignore"):
                u = np.einsum("fi,fi->f", -a, p) / determinant
                q = np.cross(-a, b - a)
                v = np.einsum("i,fi->f", ray, q) / determinant
                t = np.einsum("fi,fi->f", c - a, q) / determinant
                hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
            if hit.any():
                depth[row, column] = t[hit].min()
    return depth


def test_rendering_agrees_with_ray_casting(rng):
    scene = Scene((tube(),))
    pose = scene.rest_pose()
    pose[:6] = se3.log(se3.exp(np.array([-0.03, 0.0, 0.25, 0, 0, 0])) @ se3.exp(np.array([0, 0, 0, 0.3, 0.5, 0.2])))
    pose[6:] = rng.normal(scale=0.4, size=4)
    vertices = scene.pose_at(pose).vertices
    rendering = render_depth(vertices, scene.arrays.faces, K, 64, 48)
    truth = cast_rays(vertices, scene.arrays.faces, 64, 48)
    both = (rendering.depth > 0) & (truth > 0)
    assert both.sum() > 200
    np.testing.assert_allclose(rendering.depth[both], truth[both], atol=1e-9)
    assert ((rendering.depth > 0) != (truth > 0)).sum() <= 2  # a ray through an edge may fall on either side


def test_nothing_is_drawn_behind_the_camera():
    rendering = render_depth(tube().vertices - [0, 0, 1.0], tube().faces, K, 64, 48)
    assert not rendering.depth.any()
    assert (rendering.face == -1).all()


def test_a_closed_mesh_looks_the_same_with_its_hidden_faces_left_out(rng):
    scene = Scene((tube(),))
    assert not scene.open_faces.any()
    pose = scene.rest_pose()
    pose[:6] = [-0.03, 0.0, 0.25, 0.2, 0.4, 0.1]
    posed = scene.pose_at(pose)
    view = render_view(posed, K, np.eye(4), 48, 64)
    np.testing.assert_array_equal(view.face, render_depth(posed.vertices, scene.arrays.faces, K, 64, 48).face)

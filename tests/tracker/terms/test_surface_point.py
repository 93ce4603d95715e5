"""The point of a mesh at a pixel is the one that projects there."""

import numpy as np

from tests.tracker.toys import tube
from tracker.model.scene import Scene
from tracker.rendering import render_view
from tracker.terms.surface_point import find_shares

K = np.array([[300.0, 0.0, 40.0], [0.0, 300.0, 30.0], [0.0, 0.0, 1.0]])


def test_shares_give_the_point_that_projects_into_the_pixel(rng):
    scene = Scene((tube(),))
    pose = scene.rest_pose()
    pose[:6] = [-0.03, 0.005, 0.3, 0.2, -0.5, 0.1]
    posed = scene.pose_at(pose)
    view = render_view(posed, K, np.eye(4), 60, 80)
    rows, columns = np.nonzero(view.face >= 0)
    ids = scene.arrays.faces[view.face[rows, columns]]
    shares = find_shares(ids, view.projected, columns, rows)
    np.testing.assert_allclose(shares.sum(axis=1), 1.0)
    x, y, z = np.einsum("nc,nci->in", shares, posed.vertices[ids])
    np.testing.assert_allclose(K[0, 0] * x / z + K[0, 2], columns, atol=1e-6)
    np.testing.assert_allclose(K[1, 1] * y / z + K[1, 2], rows, atol=1e-6)
    np.testing.assert_allclose(1.0 / z, view.inverse_depth[rows, columns], rtol=1e-6)
    assert len(rows) > 200

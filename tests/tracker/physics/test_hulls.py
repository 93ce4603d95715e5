"""Hulls hold what follows a bone and nothing else."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from tests.tracker.grips import ball, cube
from tests.tracker.toys import tube
from tracker.physics.hulls import MAX_VERTICES, build_hull, find_bone_hulls


def test_every_vertex_lies_in_the_hull_of_the_bone_it_follows_most():
    model = tube(bones=3)
    heaviest = np.argmax(model.skinning_weights, axis=1)
    hulls = find_bone_hulls(model)
    assert [hull.bone for hull in hulls] == [0, 1, 2]
    for hull in hulls:
        planes = ConvexHull(hull.vertices).equations
        inside = model.vertices[heaviest == hull.bone] - hull.center
        assert (inside @ planes[:, :3].T + planes[:, 3]).max() < 1e-9


def test_centre_and_volume_are_those_of_the_body():
    (hull,) = find_bone_hulls(cube(0.04))
    np.testing.assert_allclose(hull.center, 0.0, atol=1e-12)
    assert hull.volume == pytest.approx(0.04**3)
    moved = build_hull(0, hull.vertices + np.array([1.0, 2.0, 3.0]))
    np.testing.assert_allclose(moved.center, [1.0, 2.0, 3.0])


def test_a_round_thing_is_thinned_out_and_stays_round():
    (hull,) = find_bone_hulls(ball(0.02))
    assert len(hull.vertices) <= MAX_VERTICES
    assert ConvexHull(hull.vertices).volume > 0.95 * ConvexHull(ball(0.02).vertices).volume


@pytest.mark.parametrize("points", [[[0, 0, 0]], [[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]])
def test_flat_things_are_given_a_thickness(points):
    hull = build_hull(0, 0.01 * np.array(points, dtype=np.float64))
    assert hull.volume > 0.0 and len(hull.vertices) >= 4

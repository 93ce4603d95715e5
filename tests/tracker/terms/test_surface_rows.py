"""Surface points are shares of vertices, and a vertex is one, too."""

import numpy as np

from tests.tracker.toys import tube
from tracker.model.scene import Scene
from tracker.terms.surface_rows import SurfaceRows, span


def test_points_are_the_shares_of_their_vertices_and_vertices_are_themselves(rng):
    scene = Scene((tube(),))
    posed = scene.pose_at(0.1 * rng.normal(size=scene.num_dofs))
    ids, shares = scene.arrays.faces[:9], rng.dirichlet(np.ones(3), 9)
    found = SurfaceRows(ids, shares)
    assert found.count == 9
    plain = [sum(shares[n, k] * posed.vertices[ids[n, k]] for k in range(3)) for n in range(9)]
    np.testing.assert_allclose(found.points(posed), plain, atol=1e-14)
    np.testing.assert_array_equal(SurfaceRows(*span(np.array([7, 2]))).points(posed), posed.vertices[[7, 2]])

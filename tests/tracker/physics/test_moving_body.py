"""However an object is put together, it has the mass, the centre and the inertia of its parts."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker.physics.hulls import build_hull
from tracker.physics.moving_body import build_moving_body


def inertia_about(point, parts):
    """(3, 3) of (mass, centre, R, moments) about a point."""
    total = np.zeros((3, 3))
    for mass, center, R, moments in parts:
        arm = center - point
        total += R @ np.diag(moments) @ R.T + mass * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
    return total


@pytest.mark.parametrize("near", [(), (0,), (2, 4), (0, 1, 2, 3, 4)])
def test_mass_centre_and_inertia_are_those_of_the_parts(rng, near):
    hulls = [build_hull(i, rng.normal(scale=0.02, size=(12, 3))) for i in range(5)]
    Rs = Rotation.from_rotvec(rng.normal(size=(5, 3))).as_matrix()
    centers, masses = rng.normal(scale=0.1, size=(5, 3)), rng.uniform(0.1, 0.4, size=5)
    body = build_moving_body(hulls, Rs, centers, masses, np.isin(np.arange(5), near))
    parts = [(masses[i], centers[i], Rs[i], masses[i] * hulls[i].inertia_per_mass) for i in range(5)]
    built = [(body.mass, body.center, body.R, body.inertia), *(parts[link] for link in body.links)]
    middle = masses @ centers / masses.sum()
    assert sum(part[0] for part in built) == pytest.approx(masses.sum())
    np.testing.assert_allclose(sum(part[0] * part[1] for part in built), masses.sum() * middle, atol=1e-12)
    np.testing.assert_allclose(inertia_about(middle, built), inertia_about(middle, parts), atol=1e-12)
    assert np.linalg.det(body.R) == pytest.approx(1.0)
    everything_near = len(near) == 5
    assert (body.base, body.links) == ((0, (1, 2, 3, 4)) if everything_near else (-1, near))

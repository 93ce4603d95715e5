"""Rigid motions keep the properties of their group, near the identity and near a half turn too."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker.geometry import se3


def random_twists(rng: np.random.Generator) -> list[np.ndarray]:
    twists = []
    for angle in (0.0, 1e-9, 1e-5, 0.3, 2.0, np.pi - 1e-7, np.pi - 1e-3):
        axis = rng.normal(size=3)
        twists.append(np.concatenate([rng.normal(size=3), angle * axis / np.linalg.norm(axis)]))
    return twists


def test_log_undoes_exp(rng):
    for twist in random_twists(rng):
        np.testing.assert_allclose(se3.exp(se3.log(se3.exp(twist))), se3.exp(twist), atol=1e-9)
        if np.linalg.norm(twist[3:]) < 3.0:
            np.testing.assert_allclose(se3.log(se3.exp(twist)), twist, atol=1e-9)


def test_exp_agrees_with_its_power_series(rng):
    for twist in random_twists(rng):
        generator = np.zeros((4, 4))
        x, y, z = twist[3:]
        generator[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
        generator[:3, 3] = twist[:3]
        series, power = np.eye(4), np.eye(4)
        for k in range(1, 40):
            power = power @ generator / k
            series = series + power
        np.testing.assert_allclose(se3.exp(twist), series, atol=1e-9)


def test_inverse_times_motion_is_the_identity(rng):
    for twist in random_twists(rng):
        T = se3.exp(twist)
        np.testing.assert_allclose(se3.inverse(T) @ T, np.eye(4), atol=1e-12)
        np.testing.assert_allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-12)
        assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)


def test_transform_moves_points_as_the_matrix_does(rng):
    T, points = se3.exp(rng.normal(size=6)), rng.normal(size=(5, 3))
    homogeneous = np.c_[points, np.ones(5)] @ T.T
    np.testing.assert_allclose(se3.transform(T, points), homogeneous[:, :3])


@pytest.mark.parametrize("flip", [1.0, -1.0])
def test_points_are_laid_onto_others_by_a_rotation_even_where_a_mirror_image_would_fit_better(rng, flip):
    points = rng.normal(size=(30, 3))
    turns = Rotation.random(4, rng=rng).as_matrix()
    others = np.einsum("nij,pj->npi", turns, points * [1.0, 1.0, flip])
    found = se3.find_rotations(np.einsum("npi,pj->nij", others, points))
    np.testing.assert_allclose(np.linalg.det(found), 1.0)
    if flip > 0.0:
        np.testing.assert_allclose(found, turns, atol=1e-12)
    best = np.einsum("nij,pj,npi->n", found, points, others)
    for other in Rotation.random(50, rng=rng).as_matrix():
        assert np.all(np.einsum("ij,pj,npi->n", other, points, others) <= best + 1e-9)

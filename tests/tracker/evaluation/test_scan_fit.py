from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker.evaluation.scan_fit import (
    find_left_jacobian,
    fit_pose_to_vertices,
    fit_to_scan,
    fit_to_vertices,
    measure_scan,
    with_template,
    without_pose_shapes,
)
from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.curved_triangles import find_bulges
from tracker.registration.surface_search import SurfaceSearch


@pytest.fixture(scope="module")
def model():
    """The untrained hand with blend shapes and a pose space by chance."""
    rng = np.random.default_rng(0)
    crude = untrained_hand("right")
    components = np.linalg.qr(rng.normal(size=(45, 45)))[0].T
    return replace(
        crude,
        pose_directions=1e-3 * rng.normal(size=crude.pose_directions.shape) * (rng.random((1, 1, 135)) < 0.1),
        pose_mean=0.1 * rng.normal(size=45),
        pose_components=components,
    )


@pytest.fixture(scope="module")
def posed(model):
    rng = np.random.default_rng(1)
    pose = np.concatenate([[[0.3, -1.0, 2.0]], 0.25 * rng.normal(size=(15, 3))])
    return model.pose_at(pose, 0.5 * rng.normal(size=model.num_shape), np.array([0.1, 0.2, -0.3]))


def test_pose_and_shape_come_back_from_vertices(model, posed):
    found = fit_to_vertices(model, posed.vertices)
    assert np.abs(found.posed.vertices - posed.vertices).max() < 0.3e-3
    assert np.linalg.norm(found.posed.joints - posed.joints, axis=1).max() < 0.3e-3


def test_pose_comes_back_exactly_where_the_template_is_known(model, posed):
    own = with_template(model, posed.arrays.shaped)
    found = fit_pose_to_vertices(own, posed.vertices)
    np.testing.assert_allclose(found.posed.vertices, posed.vertices, atol=1e-7)
    off = fit_pose_to_vertices(without_pose_shapes(own), posed.vertices)
    assert np.abs(off.posed.vertices - posed.vertices).max() > 1e-4


def make_scan(posed):
    """Points (N, 3) within the curved faces of the posed mesh, and normals (N, 3)."""
    rng = np.random.default_rng(2)
    ids = rng.integers(0, len(posed.model.faces), 3000)
    faces = posed.model.faces[ids]
    shares = rng.dirichlet(np.ones(3), 3000)
    normals = find_unit_normals(posed.vertices, posed.model.faces)
    bulges = find_bulges(posed.vertices, posed.model.faces)[ids]
    on_flat = np.einsum("nk,nki->ni", shares, posed.vertices[faces])
    return on_flat + np.einsum("nk,nki->ni", 4.0 * shares * np.roll(shares, -1, axis=1), bulges), normals[faces[:, 0]]


def test_a_fit_to_a_scan_ends_on_its_surface(model, posed):
    points, normals = make_scan(posed)
    search = SurfaceSearch(model.template, model.faces)
    start = fit_to_vertices(model, posed.vertices + np.random.default_rng(3).normal(0, 2e-3, posed.vertices.shape))
    found = fit_to_scan(start, search, points, normals)
    assert np.nanmean(measure_scan(found, search, points)) < 0.1e-3
    assert np.nanmean(measure_scan(found, search, points)) < 0.5 * np.nanmean(measure_scan(start, search, points))


def test_with_more_components_a_scan_is_met_better_and_with_all_as_well_as_with_none(model, posed):
    points, normals = make_scan(posed)
    search = SurfaceSearch(model.template, model.faces)
    start = fit_to_vertices(model, posed.vertices)
    errors = [
        np.nanmean(measure_scan(fit_to_scan(start, search, points, normals, num_components=count), search, points))
        for count in (0, 20, 45)
    ]
    assert errors[0] > errors[1] > errors[2] and errors[2] < 0.15e-3
    none = fit_to_scan(start, search, points, normals, num_components=0)
    np.testing.assert_allclose(none.pose[1:].ravel(), model.pose_mean, atol=1e-12)


@pytest.mark.parametrize("size", [0.0, 1e-8, 0.3, 2.5])
def test_the_left_jacobian_is_that_of_finite_differences(size):
    vector = size * np.array([0.6, -0.64, 0.48])
    J = np.empty((3, 3))
    for axis, step in enumerate(1e-6 * np.eye(3)):
        after, before = Rotation.from_rotvec(vector + step), Rotation.from_rotvec(vector - step)
        J[:, axis] = (after * before.inv()).as_rotvec() / 2e-6
    np.testing.assert_allclose(find_left_jacobian(vector), J, atol=1e-8)

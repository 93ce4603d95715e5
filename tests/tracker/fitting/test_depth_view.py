"""A depth image as one of several views."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import HAND, SCENE, look_from
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.depth_view import DepthView
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.frame_fit import FitOptions, find_residuals, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.region import region_around
from tracker.geometry import se3
from tracker.observation import Observation, Preprocessing, observe
from tracker.rendering import render_view


@pytest.fixture(scope="module")
def truth() -> np.ndarray:
    pose = SCENE.rest_pose()
    pose[6:] = curl_fingers(HAND, 0.3)
    T = se3.exp(np.array([0.0, 0.0, 0.0, 0.6, -0.4, 0.9]))
    T[:3, 3] -= (T @ np.append(SCENE.pose_at(pose).landmarks(0).mean(axis=0), 1.0))[:3]
    pose[:6] = se3.log(T @ se3.exp(pose[:6]))
    return pose


def take(truth: np.ndarray, camera: Camera) -> Observation:
    posed = SCENE.pose_at(truth)
    drawn = render_view(posed, camera.K, camera.T_world_camera, camera.height, camera.width)
    frame = Frame(0, camera.id, None, drawn.depth.astype(np.float32))
    region = region_around(posed.vertices, camera)
    assert region is not None
    return observe(frame, camera, region, Preprocessing())


@pytest.fixture(scope="module")
def observations(truth) -> list[Observation]:
    return [take(truth, look_from(angle)) for angle in (0.0, 1.2)]


def near(truth: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    pose = truth.copy()
    pose[:3] += [0.003, -0.002, 0.003]
    pose[6:] += rng.normal(0.0, 0.05, len(pose) - 6)
    return pose


def test_a_fit_is_the_same_whether_a_depth_image_is_the_frame_or_one_view_of_it(truth, observations, rng):
    start = near(truth, rng)
    alone = fit_frame(SCENE, observations[0], start, start, Objective(), FitOptions())
    view = DepthView.of(observations[0], 1.0)
    in_view = fit_frame(SCENE, None, start, start, Objective(terms={"depth": view}), FitOptions())
    np.testing.assert_allclose(in_view.pose, alone.pose, atol=1e-12)


def test_correspondences_of_all_views_are_looked_for_by_name(truth, observations):
    views = {f"depth_{n}": DepthView.of(seen, 1.0) for n, seen in enumerate(observations)}
    posed = SCENE.pose_at(truth)
    found = find_residuals(posed, None, Objective(terms=dict(views)))
    assert list(found) == [f"depth_{n}_{name}" for n in (0, 1) for name in Objective().terms]
    for number, seen in enumerate(observations):
        for name, residual in find_residuals(posed, seen, Objective()).items():
            assert found[f"depth_{number}_{name}"].count == residual.count
    together = views["depth_0"].find(posed)
    block = together.linearize(posed)
    assert together.count > 500 and len(together.segments(posed)) == together.count
    assert block.jacobian.shape == (len(block.residual), SCENE.num_dofs)


def test_two_depth_images_tell_more_than_one(truth, observations, rng):
    start = near(truth, rng)
    errors = []
    for count in (1, 2):
        terms = {f"depth_{n}": DepthView.of(seen, 1.0) for n, seen in enumerate(observations[:count])}
        pose = fit_frame(SCENE, None, start, start, Objective(terms=dict(terms)), FitOptions(iterations=20)).pose
        apart = SCENE.pose_at(pose).landmarks(0) - SCENE.pose_at(truth).landmarks(0)
        errors.append(1000.0 * float(np.linalg.norm(apart, axis=1).mean()))
    assert errors[1] < 0.7 * errors[0] and errors[1] < 0.5, errors

"""Detected nails are given to the nails that a view shows, and pull the hand to where they were seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import look_from
from tracker.capture.camera import Camera
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.rendering import render_view
from tracker.rendering.seen_nails import NailPlaces
from tracker.terms.nails import Nails, SeenNails

SCENE = Scene((default_hand("right"),))
PLACES = NailPlaces.of(SCENE)
CAMERAS = [replace(look_from(angle), distortion=np.zeros(0)) for angle in (2.6, 3.1, 3.7)]
"""They look at the back of the hand."""


def look(pose: np.ndarray, camera: Camera) -> SeenNails:
    """What a perfect detector would find."""
    posed = SCENE.pose_at(pose)
    depth = render_view(posed, camera.K, camera.T_world_camera, camera.height, camera.width).depth
    is_visible = PLACES.find_visible(posed.vertices, camera, depth, np.zeros(2))
    return SeenNails(camera, camera.project(PLACES.points(posed.vertices))[is_visible], is_visible)


@pytest.fixture
def pose() -> np.ndarray:
    return SCENE.rest_pose()


def test_the_back_of_a_hand_shows_nails_and_the_palm_shows_none_of_the_fingers(pose):
    assert all(look(pose, camera).is_visible[1:].all() for camera in CAMERAS)
    assert not look(pose, look_from(0.0)).is_visible[1:].any()


def test_every_detection_goes_to_its_nail_and_false_ones_to_none(pose):
    view = look(pose, CAMERAS[1])
    order = np.random.default_rng(0).permutation(len(view.pixels))
    seen = SeenNails(view.camera, np.vstack([view.pixels[order], [[5.0, 5.0]]]), view.is_visible)
    nails = Nails(PLACES, [seen])
    found = nails.assign(seen, PLACES.points(SCENE.pose_at(pose).vertices))
    np.testing.assert_array_equal(found, [*np.flatnonzero(view.is_visible)[order], -1])
    residual = nails.find(SCENE.pose_at(pose))
    assert residual.count == len(order)
    assert residual.linearize(SCENE.pose_at(pose)).cost < 1e-9


def test_a_hidden_nail_gets_no_detection(pose):
    view = look(pose, CAMERAS[1])
    hidden = SeenNails(view.camera, view.pixels, np.zeros_like(view.is_visible))
    assert Nails(PLACES, [hidden]).find(SCENE.pose_at(pose)).count == 0
    assert Nails(PLACES, []).find(SCENE.pose_at(pose)).count == 0


def test_nails_bring_fingers_back_that_are_bent_wrongly(pose):
    seen = [look(pose, camera) for camera in CAMERAS]
    nails, wrong = Nails(PLACES, seen), pose.copy()
    wrong[:3] += [0.004, -0.003, 0.002]
    wrong[6:] += 0.06
    fit = fit_frame(SCENE, None, wrong, wrong, Objective(terms={"nails": nails}), FitOptions(iterations=20, fine=0))

    def measure(at: np.ndarray) -> float:
        apart = PLACES.points(SCENE.pose_at(at).vertices) - PLACES.points(SCENE.pose_at(pose).vertices)
        return float(np.linalg.norm(apart[1:], axis=1).max())

    assert measure(wrong) > 0.006
    assert measure(fit.pose) < 0.001

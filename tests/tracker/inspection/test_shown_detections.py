"""Detections as people look at them: each at most with one fingertip, and no fingertip with two."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from tests.tracker.scenes import CAMERA, K, palm_to_camera
from tracker.detection import Detection
from tracker.inspection.shown_detections import show_detections
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS
from tracker.model.scene import Scene
from tracker.rendering import render_view
from tracker.terms.salient import Salient

MODELS = (default_hand("left"), default_hand("right"))
SCENE = Scene(MODELS)
POSE = np.r_[palm_to_camera(MODELS[0], (0.1, 0.0, 0.5)), palm_to_camera(MODELS[1], (-0.1, 0.0, 0.5))]
POSED = SCENE.pose_at(POSE)
VIEW = render_view(POSED, K, np.eye(4), 240, 320)


def detect(point: np.ndarray, confidence: float = 4.0) -> Detection:
    """A fingertip of 16 px at a point (3,) before the camera, m."""
    center = CAMERA.project(point[None])[0]
    box = np.r_[center - 8.0, center + 8.0]
    rays = (box - np.tile(K[:2, 2], 2)) / np.tile([K[0, 0], K[1, 1]], 2)
    return Detection(center, box, rays, confidence, float(point[2]), point[None], point)


def tips() -> dict[tuple[int, int], np.ndarray]:
    """Model and finger to the middle of its fingertip as it is seen, m."""
    seen = Salient(()).find_fingertips(POSED, VIEW)
    found = {}
    for vertices, centroid in zip(seen.vertices, seen.centroids, strict=True):
        for index, (model, where) in enumerate(zip(MODELS, SCENE.vertex_slices, strict=True)):
            assert model.hand is not None
            for finger, ids in enumerate(model.hand.fingertips):
                if np.isin(vertices[0] - where.start, ids):
                    found[index, finger] = centroid
    return found


def test_a_detection_on_a_fingertip_belongs_to_it_whichever_hand_that_is_of():
    own = tips()
    assert {model for model, _ in own} == {0, 1} and len(own) >= 8
    shown = show_detections(POSED, VIEW, tuple(detect(point) for point in own.values()), np.eye(4))
    for (model, finger), each in zip(own, shown, strict=True):
        assert (each.model, each.finger, each.finger_name) == (model, finger, FINGERS[finger])
        assert each.distance < 1e-6
        np.testing.assert_allclose(each.position, own[model, finger], atol=1e-6)


@pytest.mark.parametrize(("off", "is_its_own"), [(0.9, True), (1.1, False)])
def test_a_detection_is_of_a_fingertip_up_to_a_limit_and_beyond_it_of_nobody(off, is_its_own):
    point = tips()[1, 2] - (0.0, 2.0 * off * Salient(()).rejection, 0.0)  # above the middle finger
    (shown,) = show_detections(POSED, VIEW, (detect(point),), np.eye(4))
    assert (shown.model >= 0) is is_its_own
    if not is_its_own:
        assert (shown.model, shown.finger, shown.finger_name, shown.distance) == (-1, -1, "", 0.0)
        np.testing.assert_array_equal(shown.tip, shown.position)


def test_of_two_detections_on_one_fingertip_the_nearer_has_it_in_whatever_order_they_are_told():
    own = tips()
    near, far = detect(own[1, 0] + (0.0, 0.002, 0.0)), detect(own[1, 0] + (0.0, 0.02, 0.0))
    other = detect(own[0, 1])
    for order in permutations((near, far, other)):
        shown = show_detections(POSED, VIEW, order, np.eye(4))
        owners = {id(each): (one.model, one.finger) for each, one in zip(order, shown, strict=True)}
        assert owners[id(near)] == (1, 0) and owners[id(other)] == (0, 1) and owners[id(far)] == (-1, -1)


def test_a_box_surrounds_its_detection_in_the_image_at_its_depth_wherever_the_camera_stands():
    point = tips()[1, 1]
    (shown,) = show_detections(POSED, VIEW, (detect(point),), np.eye(4))
    corners = CAMERA.project(shown.box.astype(np.float64))
    np.testing.assert_allclose(corners.mean(axis=0), CAMERA.project(point[None])[0], atol=0.01)
    np.testing.assert_allclose(np.ptp(corners, axis=0), 16.0, atol=0.01)
    np.testing.assert_allclose(shown.box[:, 2], point[2], atol=1e-6)


def test_without_detections_or_without_a_fingertip_in_sight_nothing_is_assigned():
    assert show_detections(POSED, VIEW, (), np.eye(4)) == ()
    away = SCENE.pose_at(POSE + np.r_[5.0, np.zeros(len(POSE) - 1)] + np.eye(len(POSE))[MODELS[0].num_dofs] * 5.0)
    nothing = render_view(away, K, np.eye(4), 240, 320)
    (shown,) = show_detections(away, nothing, (detect(tips()[1, 1]),), np.eye(4))
    assert (shown.model, shown.distance) == (-1, 0.0)

"""Cameras as pyramids that end on the rim of their images, and rays that end beside the joints they saw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import look_from
from tracker.fitting.view_hands import ViewHands
from tracker.geometry import se3
from tracker.inspection.shown_cameras import LENGTH, show_cameras
from tracker.landmarks import DetectedHand

CAMERAS = tuple(look_from(angle) for angle in (0.0, 0.9))


@pytest.fixture
def joints(rng) -> np.ndarray:
    """(21, 3) about the origin, m."""
    return rng.uniform(-0.08, 0.08, (21, 3))


def detected(points: np.ndarray) -> DetectedHand:
    return DetectedHand(points, np.zeros((21, 3)), 1.0, 1.0)


@pytest.mark.parametrize("camera", CAMERAS)
def test_a_pyramid_stands_on_the_camera_and_its_base_is_the_rim_of_the_image_a_share_of_the_way_to_the_hands(
    camera, joints
):
    (shown,) = show_cameras((camera,), {"right": joints}, None)
    sides, base = shown.outline[:4], shown.outline[4:]
    np.testing.assert_allclose(sides[:, 0], np.tile(camera.T_world_camera[:3, 3], (4, 1)), atol=1e-6)
    np.testing.assert_array_equal(base[:, 0], sides[:, 1])
    np.testing.assert_array_equal(base[:, 1], np.roll(sides[:, 1], -1, axis=0))
    rim = [[-0.5, -0.5], [camera.width - 0.5, -0.5], [camera.width - 0.5, camera.height - 0.5]]
    rim.append([-0.5, camera.height - 0.5])
    np.testing.assert_allclose(camera.project(sides[:, 1].astype(np.float64)), rim, atol=0.01)
    depth = ((sides[:, 1] - camera.T_world_camera[:3, 3]) @ camera.T_world_camera[:3, 2]).astype(np.float64)
    away = np.linalg.norm(joints.mean(axis=0) - camera.T_world_camera[:3, 3])
    np.testing.assert_allclose(depth, LENGTH * away, rtol=1e-4)
    assert len(shown.rays) == len(shown.joints) == 0


def test_a_ray_ends_at_the_joint_that_was_seen_where_it_is_and_else_at_the_nearest_place_on_it(joints, rng):
    off = rng.normal(scale=20.0, size=(21, 2))
    for noise in (0.0, 1.0):
        hands = [{"right": detected(camera.project(joints) + noise * off)} for camera in CAMERAS]
        shown = show_cameras(CAMERAS, {"right": joints}, ViewHands(CAMERAS, tuple(hands)))
        for camera, seen, each in zip(CAMERAS, hands, shown, strict=True):
            start, end = each.rays.astype(np.float64).transpose(1, 0, 2)
            np.testing.assert_array_equal(each.joints, np.arange(21))
            np.testing.assert_allclose(camera.project(end), seen["right"].points, atol=0.02)
            np.testing.assert_allclose(np.einsum("ji,ji->j", joints - end, end - start), 0.0, atol=1e-6)
            if not noise:
                np.testing.assert_allclose(end, joints, atol=1e-6)


def test_joints_that_were_not_seen_or_are_behind_the_camera_have_no_ray(joints):
    points = CAMERAS[0].project(joints)
    points[[3, 7]] = np.nan
    behind = joints.copy()
    behind[11] = 3.0 * CAMERAS[0].T_world_camera[:3, 3]
    seen = ViewHands(CAMERAS, ({"right": detected(points)}, {}))
    first, second = show_cameras(CAMERAS, {"right": behind}, seen)
    assert first.joints.tolist() == [joint for joint in range(21) if joint not in (3, 7, 11)]
    assert np.isfinite(first.rays).all() and len(second.rays) == 0


def test_hands_that_are_not_fitted_have_no_rays_and_two_hands_those_of_both_in_either_order(joints):
    both = {"right": joints, "left": joints + 0.1}
    hands = {name: detected(CAMERAS[0].project(place)) for name, place in both.items()}
    seen = ViewHands(CAMERAS[:1], (hands,))
    (every,) = show_cameras(CAMERAS[:1], both, seen)
    assert len(every.rays) == 42
    (one,) = show_cameras(CAMERAS[:1], {"left": both["left"]}, seen)
    np.testing.assert_allclose(one.rays[:, 1], both["left"], atol=1e-6)
    (turned,) = show_cameras(CAMERAS[:1], dict(reversed(both.items())), seen)
    np.testing.assert_array_equal(turned.rays, every.rays)


def test_cameras_keep_their_order_and_those_without_colour_have_a_pyramid_too(joints):
    blind = replace(CAMERAS[1], id="depth")
    seen = ViewHands(CAMERAS[:1], ({"right": detected(CAMERAS[0].project(joints))},))
    shown = show_cameras((blind, CAMERAS[0]), {"right": joints}, seen)
    assert [each.name for each in shown] == ["depth", CAMERAS[0].id]
    assert [len(each.rays) for each in shown] == [0, 21]
    nobody = show_cameras((replace(blind, T_world_camera=se3.exp(np.ones(6))),), {}, None)
    assert np.isfinite(nobody[0].outline).all()

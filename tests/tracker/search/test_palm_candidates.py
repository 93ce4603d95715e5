"""Where a palm could be: on discs of its size, nearest first, apart from each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import CAMERA, palm_to_camera, photograph
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.region import whole_image
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.observation import Observation, Preprocessing, observe
from tracker.search.palm_candidates import APART, MAX_RADIUS, MIN_RADIUS, find_palm_candidates

FOCAL = float(CAMERA.K[0, 0])


def see(depth: np.ndarray, camera: Camera = CAMERA, is_hand: np.ndarray | None = None, stride: int = 1) -> Observation:
    frame = Frame(0, "cam0", None, depth.astype(np.float32), is_hand)
    how = Preprocessing(bilateral_diameter=0)
    return observe(frame, camera, whole_image(camera, 0.1, 3.0), how, stride)


def disc(column: int, row: int, radius: float, z: float, behind: float = 0.0) -> np.ndarray:
    """(240, 320) depth of a disc that faces the camera, its radius in m, before a wall; 0 for no wall."""
    rows, columns = np.mgrid[:240, :320]
    inside = np.hypot(rows - row, columns - column) <= radius * FOCAL / z
    return np.where(inside, z, behind)


@pytest.mark.parametrize("behind", [0.0, 0.8])
@pytest.mark.parametrize("z", [0.3, 0.5, 0.7])
def test_the_middle_of_a_palm_sized_disc_is_a_place_and_its_normal_comes_towards_the_camera(z, behind):
    first = find_palm_candidates(see(disc(150, 110, 0.035, z, behind)), 5)[0]
    expected = CAMERA.lift(np.array([[150.0, 110.0]]), np.array([z]))[0]
    assert np.linalg.norm(first.point - expected) < 0.008
    np.testing.assert_allclose(first.normal, [0.0, 0.0, -1.0], atol=1e-3)


@pytest.mark.parametrize(
    ("radius", "is_found"),
    [(0.8 * MIN_RADIUS, False), (1.4 * MIN_RADIUS, True), (0.9 * MAX_RADIUS, True), (1.2 * MAX_RADIUS, False)],
)
def test_fingers_are_too_thin_and_trunks_too_wide(radius, is_found):
    assert bool(find_palm_candidates(see(disc(150, 110, radius, 0.5)), 5)) is is_found


def test_a_hand_has_a_place_on_its_palm():
    hand = default_hand("right")
    scene, pose = Scene((hand,)), palm_to_camera(hand, (0.0, 0.0, 0.45))
    frame = photograph(scene, pose)
    assert frame.depth is not None
    joints = scene.pose_at(pose).landmarks(0)
    palm = 0.5 * (joints[0] + joints[9])
    places = find_palm_candidates(see(frame.depth, stride=2), 8)
    assert min(np.linalg.norm(place.point - palm) for place in places) < 0.035


def test_nearer_places_come_first_and_all_keep_their_distance():
    depth = np.max([disc(60, 60, 0.03, 0.6), disc(240, 60, 0.03, 0.4), disc(160, 180, 0.03, 0.5)], axis=0)
    places = find_palm_candidates(see(depth), 20)
    depths = [place.point[2] for place in places]
    assert depths == sorted(depths)
    assert depths[0] == pytest.approx(0.4) and depths[-1] == pytest.approx(0.6)
    points = np.array([place.point for place in places])
    apart = np.linalg.norm(points[:, None] - points, axis=2) + np.eye(len(points))
    assert apart.min() >= APART
    fewer = find_palm_candidates(see(depth), 2)
    assert [place.point.tolist() for place in fewer] == points[:2].tolist()


@pytest.mark.parametrize(("apart", "count"), [(0.8 * APART, 1), (1.4 * APART, 2)])
def test_two_middles_closer_than_a_palm_is_wide_are_one_place_the_nearer_one(apart, count):
    column = 100 + round(apart * FOCAL / 0.5)
    both = np.max([disc(100, 120, 0.017, 0.5), disc(column, 120, 0.017, 0.49)], axis=0)
    places = find_palm_candidates(see(both), 8)
    assert len(places) == count
    assert places[0].point[2] == pytest.approx(0.49, abs=1e-4)


def test_camera_and_scene_moved_together_have_the_same_places():
    depth = np.max([disc(60, 60, 0.03, 0.6), disc(240, 120, 0.03, 0.4)], axis=0)
    T = se3.exp(np.array([0.3, -1.0, 0.5, 0.4, 2.0, -1.0]))
    here, there = (
        find_palm_candidates(see(depth), 8),
        find_palm_candidates(see(depth, replace(CAMERA, T_world_camera=T)), 8),
    )
    assert len(here) == len(there) >= 2
    for one, other in zip(here, there, strict=True):
        np.testing.assert_allclose(other.point, se3.transform(T, one.point[None])[0], atol=1e-5)
        np.testing.assert_allclose(other.normal, T[:3, :3] @ one.normal, atol=1e-4)


def test_two_things_at_different_depths_are_no_one_disc():
    half = disc(150, 110, 0.045, 0.5)
    half[:, 150:] = np.where(half[:, 150:] > 0, 0.55, 0.0)
    whole = find_palm_candidates(see(disc(150, 110, 0.045, 0.5)), 1)[0]
    split = find_palm_candidates(see(half), 8)
    assert split and all(np.linalg.norm(place.point[:2] - whole.point[:2]) > 0.012 for place in split)


def test_what_is_no_hand_or_no_depth_has_no_place():
    depth = disc(150, 110, 0.035, 0.5)
    assert find_palm_candidates(see(depth, is_hand=np.zeros((240, 320), np.bool_)), 5) == []
    assert find_palm_candidates(see(np.zeros((240, 320))), 5) == []
    speck = np.zeros((240, 320))
    speck[0, 0] = 0.5
    assert find_palm_candidates(see(speck), 5) == []

"""Where an object could be: on things of its size first, near the hands first, apart from each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import CAMERA
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.region import whole_image
from tracker.geometry import se3
from tracker.observation import Observation, Preprocessing, observe
from tracker.search.object_candidates import FEWEST, find_object_candidates

NOWHERE = np.zeros((0, 3))
SIZE = 0.06


def see(depth: np.ndarray, camera: Camera = CAMERA, is_hand: np.ndarray | None = None) -> Observation:
    frame = Frame(0, "cam0", None, depth.astype(np.float32), is_hand)
    return observe(frame, camera, whole_image(camera, 0.1, 3.0), Preprocessing(bilateral_diameter=0, objects=True))


def square(column: int, row: int, z: float = 0.5, side: float = 0.05) -> np.ndarray:
    """(240, 320) depth of a square that faces the camera."""
    half, depth = round(0.5 * side * 300.0 / z), np.zeros((240, 320))
    depth[row - half : row + half + 1, column - half : column + half + 1] = z
    return depth


def middle(column: int, row: int, z: float = 0.5) -> np.ndarray:
    return CAMERA.lift(np.array([[column, row]]), np.array([z]))[0]


@pytest.fixture
def two_squares() -> np.ndarray:
    return square(60, 60, 0.5) + square(240, 160, 0.6)


def test_the_middle_of_each_thing_of_the_size_comes_before_all_other_places(two_squares):
    places = find_object_candidates(see(two_squares), SIZE, 0.02, NOWHERE, 40)
    assert np.linalg.norm(places[0] - middle(60, 60)) < 0.004, "without hands the nearest to the camera first"
    assert np.linalg.norm(places[1] - middle(240, 160, 0.6)) < 0.004
    assert len(places) > 4


def test_near_a_hand_comes_first_whatever_is_nearer_to_the_camera_and_in_whatever_order_hands_are_told(two_squares):
    hands = np.array([middle(240, 150, 0.6), middle(250, 100, 0.9)])
    one = find_object_candidates(see(two_squares), SIZE, 0.02, hands, 40)
    assert np.linalg.norm(one[0] - middle(240, 160, 0.6)) < 0.004
    np.testing.assert_array_equal(one, find_object_candidates(see(two_squares), SIZE, 0.02, hands[::-1], 40))
    rest = np.linalg.norm(one[2:, None] - hands, axis=2).min(axis=1)
    assert np.all(np.diff(rest) >= 0)


@pytest.mark.parametrize("apart", [0.01, 0.03, 0.2])
def test_places_are_as_many_as_asked_for_at_most_and_those_after_the_middles_keep_their_distance(two_squares, apart):
    everything = find_object_candidates(see(two_squares), SIZE, apart, NOWHERE, 1000)
    for count in (0, 1, 2, 3, len(everything)):
        some = find_object_candidates(see(two_squares), SIZE, apart, NOWHERE, count)
        assert some.shape == (min(count, len(everything)), 3)
        np.testing.assert_array_equal(some, everything[:count])
    distances = np.linalg.norm(everything[:, None] - everything, axis=2) + np.eye(len(everything))
    assert distances[2:].min(initial=np.inf) >= apart


def test_camera_and_scene_moved_together_have_the_same_places(two_squares):
    T = se3.exp(np.array([0.3, -1.0, 0.5, 0.4, 2.0, -1.0]))
    hand = middle(240, 150, 0.6)[None]
    here = find_object_candidates(see(two_squares), SIZE, 0.03, hand, 2)
    there = find_object_candidates(
        see(two_squares, replace(CAMERA, T_world_camera=T)), SIZE, 0.03, se3.transform(T, hand), 2
    )
    np.testing.assert_allclose(there, se3.transform(T, here), atol=2e-3)


@pytest.mark.parametrize(("side", "has_middle"), [(0.008, False), (0.05, True), (0.25, False)])
def test_a_thing_far_smaller_or_larger_than_the_object_may_hold_it_but_is_not_it(side, has_middle):
    depth = square(160, 120, 0.5, side)
    hand = middle(160 + round(0.45 * side * 600.0), 120)[None]
    places = find_object_candidates(see(depth), SIZE, 0.005, hand, 10)
    assert len(places)
    assert bool(np.linalg.norm(places[0] - middle(160, 120)) < 0.002) is has_middle


def test_pixels_of_a_hand_that_colour_tells_are_no_place(two_squares):
    is_hand = np.zeros((240, 320), dtype=np.bool_)
    is_hand[:, :160] = True
    places = find_object_candidates(see(two_squares, is_hand=is_hand), SIZE, 0.02, NOWHERE, 40)
    assert len(places) and np.all(places[:, 2] == np.float32(0.6))
    assert not len(find_object_candidates(see(two_squares, is_hand=~(two_squares < 0)), SIZE, 0.02, NOWHERE, 40))


def test_without_colour_the_rims_that_a_hand_leaves_are_no_place():
    rim = np.zeros((240, 320))
    rim[60:180, 100:102] = rim[60:180, 200:202] = 0.5
    assert not len(find_object_candidates(see(rim), SIZE, 0.02, NOWHERE, 40))


@pytest.mark.parametrize(("pixels", "is_place"), [(0, False), (1, False), (FEWEST - 1, False), (FEWEST, True)])
def test_a_speck_is_noise_up_to_a_size_and_a_place_from_there_on(pixels, is_place):
    depth = np.zeros((240, 320))
    depth[100:104, 100:105] = np.where(np.arange(20).reshape(4, 5) < pixels, 0.5, 0.0)
    no_hand = np.zeros((240, 320), dtype=np.bool_)
    places = find_object_candidates(see(depth, is_hand=no_hand), SIZE, 0.02, NOWHERE, 40)
    assert places.shape == (int(is_place), 3)

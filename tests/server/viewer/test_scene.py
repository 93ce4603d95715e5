"""The 3D view begins at the recording's camera and keeps the hand in sight."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from server.viewer.scene import ViewerScene
from tracker import Camera

CAMERA = Camera("cam0", 640, 480, np.array([[575.0, 0.0, 320.0], [0.0, 575.0, 240.0], [0.0, 0.0, 1.0]]), np.zeros(0))
HAND = np.array([0.1, 0.0, 0.8])


@pytest.fixture
def scene() -> Iterator[ViewerScene]:
    made = ViewerScene(CAMERA, HAND, dark=True)
    yield made
    made.close()


def test_it_begins_at_the_camera_with_the_hand_in_the_middle(scene: ViewerScene) -> None:
    start = scene.server.initial_camera
    assert np.array_equal(start.position, np.zeros(3))
    assert np.array_equal(start.look_at, HAND)


def test_a_hand_that_moves_within_the_view_leaves_it_as_it_is(scene: ViewerScene) -> None:
    scene.follow(HAND + np.array([0.08, 0.08, 0.0]))
    assert np.array_equal(scene.server.initial_camera.look_at, HAND)


def test_a_hand_that_leaves_the_view_is_looked_after_from_the_same_place(scene: ViewerScene) -> None:
    gone = HAND + np.array([-0.4, 0.1, 0.0])
    scene.follow(gone)
    start = scene.server.initial_camera
    assert np.array_equal(start.look_at, gone)
    assert np.array_equal(start.position, np.zeros(3))

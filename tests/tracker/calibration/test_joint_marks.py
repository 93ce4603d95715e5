"""Labels say of cameras only what was seen in two pictures, by somebody who looked at each."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.calibration.joint_marks import JointMarks, read_marks
from tracker.capture.annotations import Annotation, Annotations
from tracker.capture.camera import Camera

CAMERAS = tuple(Camera(f"cam{number}", 640, 480, np.diag([500.0, 500.0, 1.0])) for number in range(3))


def marked(frame: int, camera: str, visible: tuple[int, ...], hand: str = "right", v: int = 2) -> Annotation:
    """Some joints at (10 joint, frame) px."""
    points = np.zeros((21, 3))
    for joint in visible:
        points[joint] = (10.0 * joint, frame, v)
    return Annotation(frame, camera, hand, points)


def test_a_joint_counts_where_two_cameras_see_it_and_frames_stand_in_order() -> None:
    items = (
        marked(7, "cam1", (0, 4)),
        marked(2, "cam0", (0, 1, 2)),
        marked(2, "cam2", (1, 2, 3)),
        marked(7, "cam0", (4, 5)),
        marked(9, "cam0", (0, 1)),
    )
    marks = read_marks(Annotations(items), CAMERAS)
    assert marks.frame.tolist() == [2, 2, 7]
    assert marks.is_seen.tolist() == [[True, False, True], [True, False, True], [True, True, False]]
    assert marks.pixels[0, 0].tolist() == [10.0, 2.0] and marks.pixels[2, 1].tolist() == [40.0, 7.0]


@pytest.mark.parametrize(
    "other",
    [marked(2, "cam1", (0,), v=1), marked(2, "cam1", (0,), "left"), marked(3, "cam1", (0,)), marked(2, "film", (0,))],
    ids=["occluded", "the other hand", "another frame", "another camera"],
)
def test_what_is_not_the_same_visible_joint_of_one_moment_is_no_mark(other) -> None:
    marks = read_marks(Annotations((marked(2, "cam0", (0,)), other)), CAMERAS)
    assert marks.pixels.shape == (0, 3, 2) and marks.to_corners().pixels.shape == (0, 2)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 12))
def test_corners_hold_every_mark_once_by_camera_and_go_back_to_their_joints(seed, joints) -> None:
    rng = np.random.default_rng(seed)
    pixels = rng.uniform(0, 480, (joints, 3, 2))
    pixels[rng.random((joints, 3)) < 0.3] = np.nan
    marks = JointMarks(np.arange(joints), pixels)
    corners = marks.to_corners()
    assert len(corners.pixels) == marks.is_seen.sum() and (np.diff(corners.camera) >= 0).all()
    assert np.array_equal(corners.pixels, pixels[corners.moment, corners.camera])
    assert not corners.points.any() and not corners.velocity.any()


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.lists(st.integers(0, 2), min_size=2, max_size=3, unique=True))
def test_fewer_cameras_keep_the_joints_that_two_of_them_share(seed, numbers) -> None:
    rng = np.random.default_rng(seed)
    pixels = rng.uniform(0, 480, (9, 3, 2))
    pixels[rng.random((9, 3)) < 0.4] = np.nan
    few = JointMarks(np.arange(9), pixels).choose_cameras(numbers)
    expected = np.isfinite(pixels[:, numbers, 0]).sum(axis=1) >= 2
    assert few.frame.tolist() == np.flatnonzero(expected).tolist() and few.pixels.shape[1] == len(numbers)

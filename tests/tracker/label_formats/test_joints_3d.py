"""Joints in space come from the track, else from two views, else from the depth; what is lost is counted."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.label_formats.conftest import make_sequence
from tests.tracker.label_formats.hands import place_hand
from tracker.capture.annotations import Annotation, Annotations
from tracker.capture.frame_pattern import parse_pattern
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.joints_3d import Hand3D, find_hands_3d, project_hand
from tracker.label_formats.label_set import LabelSet, Notes

SEQUENCE = make_sequence(3)


def labelled(points: np.ndarray, cameras: tuple[int, ...], frame: int = 2, hand: str = "right", **more) -> LabelSet:
    """A hand that is marked in some cameras where it is."""
    everywhere = np.ones(21, dtype=bool)
    items = tuple(
        Annotation(frame, SEQUENCE.cameras[k].id, hand, project_hand(SEQUENCE.cameras[k], points, everywhere))
        for k in cameras
    )
    return LabelSet("key", SEQUENCE, list_image_names(SEQUENCE), Annotations(items), **more)


def found(labels: LabelSet) -> tuple[Hand3D, str]:
    notes = Notes()
    (hand,) = find_hands_3d(labels, notes)
    return hand, " ".join(notes.sentences())


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 99), st.sampled_from([(0, 1), (0, 2), (1, 2), (0, 1, 2)]), st.sampled_from(("right", "left")))
def test_two_views_tell_where_a_joint_is_and_that_it_was_triangulated(frame, cameras, hand) -> None:
    truth = place_hand(hand, frame)
    one, said = found(labelled(truth, cameras, 2, hand))
    assert np.abs(one.points - truth).max() < 1e-6, "m"
    assert (one.frame, one.hand, set(one.labels)) == (2, hand, {SEQUENCE.cameras[k].id for k in cameras})
    assert said == "21 joints were triangulated from two or more cameras."


def test_a_track_is_believed_before_the_marks_and_said_to_be_a_machines_guess() -> None:
    truth, guess = place_hand("right", 1), place_hand("right", 2)
    guess[4] = np.nan
    one, said = found(labelled(truth, (0, 1), track_joints={(2, "right"): guess}))
    assert np.array_equal(one.points, guess, equal_nan=True)
    assert "20 joints are those of a track" in said and "1 labelled joint has no known position in 3D and was" in said


def test_one_view_without_depth_leaves_every_joint_out() -> None:
    one, said = found(labelled(place_hand("right", 1), (1,)))
    assert np.isnan(one.points).all()
    assert said == "21 labelled joints have no known position in 3D and were left out."


def test_depth_under_a_visible_joint_is_taken_and_under_an_occluded_one_is_not(tmp_path) -> None:
    (tmp_path / "depth").mkdir()
    cv2.imwrite(str(tmp_path / "depth" / "000000.png"), np.full((480, 640), 550, np.uint16))
    camera = replace(SEQUENCE.cameras[0], depth=parse_pattern("depth/{:06d}.png"), depth_scale=0.001)
    sequence = replace(make_sequence(1), folder=tmp_path, cameras=(camera,))
    points = np.zeros((21, 3))
    points[0], points[1], points[2] = (100.0, 120.0, 2), (300.0, 200.0, 1), (635.0, 476.0, 2)
    items = (Annotation(0, camera.id, "right", points), Annotation(1, camera.id, "right", points))
    notes = Notes()
    seen, unread = find_hands_3d(LabelSet("k", sequence, list_image_names(sequence), Annotations(items)), notes)
    assert np.isfinite(seen.points).all(axis=1).nonzero()[0].tolist() == [0, 2]
    assert np.allclose(camera.project(seen.points[[0, 2]]), points[[0, 2], :2], atol=1e-6)
    assert np.allclose((seen.points[[0, 2]] @ camera.T_world_camera[:3, :3])[:, 2], 0.55)
    assert np.isnan(unread.points).all(), "an image that is missing is no depth"
    assert any("2 joints are on the skin" in sentence for sentence in notes.sentences())


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_projected_joint_is_visible_inside_outside_beyond_and_absent_where_it_is_not_known(seed) -> None:
    rng = np.random.default_rng(seed)
    camera = SEQUENCE.cameras[0]
    points = rng.uniform([-0.8, -0.8, -0.2], [0.8, 0.8, 1.0], (21, 3))
    valid = rng.random(21) < 0.8
    marks = project_hand(camera, points, valid)
    assert set(marks[:, 2]) <= {0.0, 2.0} and not marks[~valid].any() and not marks[points[:, 2] <= 0].any()
    for point, mark, is_known in zip(points, marks, valid, strict=True):
        if not is_known or point[2] <= 1e-3:
            continue
        x, y = (camera.K @ point)[:2] / point[2]
        is_inside = -0.5 <= x < 639.5 and -0.5 <= y < 479.5
        assert mark.tolist() == pytest.approx([x, y, 2.0] if is_inside else [-1.0, -1.0, 0.0])

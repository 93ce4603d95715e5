"""Checks of a label against other cameras, a track and the hand detector."""

from __future__ import annotations

import numpy as np
import pytest

from server.quality.evidence import APART_SHARE, DETECTOR_SHARE, check_detected, check_reprojection, check_residuals
from server.quality.finding import Looked
from tests.server.quality.drawn_hands import FAR_M, HEIGHT, WIDTH, K, draw_hand, label
from tracker import Camera

HAND = draw_hand()


def two_cameras() -> dict[str, Camera]:
    """Side by side, 10 cm apart, both looking straight ahead."""
    aside = np.eye(4)
    aside[0, 3] = 0.1
    return {name: Camera(name, WIDTH, HEIGHT, K, np.zeros(0), T) for name, T in (("cam0", np.eye(4)), ("cam1", aside))}


def seen_in_both(error: np.ndarray) -> list:
    """The same hand in both, in `cam1` off by (21, 2) px."""
    shifted = HAND - [K[0, 0] * 0.1 / FAR_M, 0.0]
    return [label(HAND), label(shifted + error, camera="cam1")]


def tracked(frames: range = range(20)) -> dict:
    return {("cam0", frame, "right"): HAND for frame in frames}


def test_labels_that_meet_in_space_are_looked_at_and_not_flagged() -> None:
    looked = Looked()
    labels = seen_in_both(np.zeros((21, 2)))
    assert list(check_reprojection(labels, two_cameras(), looked)) == []
    assert looked.find("reprojection") == {one.id for one in labels}


def test_a_joint_beside_where_the_other_camera_puts_it_is_flagged_in_both() -> None:
    error = np.zeros((21, 2))
    error[8, 1] = 40.0  # across the line on which it may lie
    found = list(check_reprojection(seen_in_both(error), two_cameras(), Looked()))
    assert [one.joints for one in found] == [(8,), (8,)] and all(one.score > 1.0 for one in found)
    assert "index tip is 20 px from where the other cameras put it" in found[0].reason


def test_one_camera_alone_says_nothing() -> None:
    looked = Looked()
    assert list(check_reprojection([label()], two_cameras(), looked)) == [] and not looked.find("reprojection")


def test_a_label_of_another_pose_is_flagged_once_as_a_whole() -> None:
    away = 2.0 * APART_SHARE * label().size_px
    labels = [label(HAND + np.array([away, 0.0]) if frame == 3 else HAND, frame) for frame in range(20)]
    looked = Looked()
    whole = [one for one in check_residuals(labels, tracked(), looked) if one.joints == ()]
    assert [one.label.frame for one in whole] == [3] and whole[0].score == pytest.approx(2.0)
    assert "as in 1 of 20 hands" in whole[0].reason and len(looked.find("residual")) == 20


def test_one_joint_far_from_the_track_is_named() -> None:
    moved = HAND.copy()
    moved[4] += [50.0, 0.0]
    labels = [label(moved if frame == 3 else HAND, frame) for frame in range(20)]
    (found,) = check_residuals(labels, tracked(), Looked())
    assert (found.label.frame, found.joints) == (3, (4,))
    assert found.reason == "The thumb tip is 50 px from the track; usually it is 0.0 px."


def test_joints_that_a_track_had_a_part_in_are_not_judged_by_it() -> None:
    looked = Looked()
    labels = [label(HAND + 90.0, frame, is_independent=False) for frame in range(3)]
    assert list(check_residuals(labels, tracked(), looked)) == [] and not looked.find("residual")
    assert list(check_residuals(labels, {}, looked)) == []


def test_the_detector_speaks_only_where_nothing_better_does() -> None:
    far = label(HAND + np.array([2.0 * DETECTOR_SHARE * label().size_px, 0.0]))
    looked = Looked()
    (found,) = check_detected([far], tracked(), looked)
    assert found.kind == "detector" and found.score == pytest.approx(2.0) and looked.find("detector") == {far.id}
    looked.at("jump", far)
    assert list(check_detected([far], tracked(), looked)) == []


def test_the_detector_says_nothing_of_few_joints() -> None:
    few = np.where(np.arange(21)[:, None] < 3, HAND + 99.0, np.nan)
    assert list(check_detected([label(few)], tracked(), Looked())) == []
    assert list(check_detected([label()], {}, Looked())) == []

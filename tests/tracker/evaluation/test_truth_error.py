"""Errors against the truth are what the track was made wrong by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.errors import TrackerError
from tracker.evaluation import evaluate_against_truth
from tracker.geometry import se3


def move_towards_x(metres: float, frames: slice = slice(None)):
    def change(poses: np.ndarray) -> None:
        for pose in poses[frames]:
            T = se3.exp(pose[:6])
            T[0, 3] += metres
            pose[:6] = se3.log(T)

    return change


def test_the_true_poses_have_no_error(known):
    error = evaluate_against_truth(known.track(), known.truth)
    assert error.error.max() < 1e-9
    assert np.nanmax(error.error_px) < 1e-6
    assert not error.is_lost.any()


def test_a_track_5_mm_aside_is_5_mm_off_at_every_joint(known):
    error = evaluate_against_truth(known.track(move_towards_x(0.005)), known.truth)
    np.testing.assert_allclose(error.error, 0.005, atol=1e-9)
    document = error.to_json()
    assert document["joint_error_mm"]["mean"] == pytest.approx(5.0)
    assert document["joint_error_mm"]["std"] == pytest.approx(0.0, abs=1e-6)
    assert document["worst_frame_mm"] == pytest.approx(5.0)
    assert document["joint_error_px"]["mean"] == pytest.approx(525 * 0.005 / 0.5, rel=0.1)


def test_more_than_40_mm_is_lost_and_silently_so_unless_the_tracker_says_it(known):
    statuses = ("ok", "ok", "ok", "lost", "recovered")
    error = evaluate_against_truth(known.track(move_towards_x(0.041, slice(2, None)), statuses), known.truth)
    document = error.to_json()
    assert document["lost"] == [2, 3, 4]
    assert document["silently_lost"] == [2, 4]
    assert document["worst"][0]["frame"] in (2, 3, 4)
    assert not evaluate_against_truth(known.track(move_towards_x(0.039)), known.truth).is_lost.any()


def test_only_frames_that_both_have_are_compared(known):
    late = replace(known.truth, frame=known.truth.frame + 3)
    error = evaluate_against_truth(known.track(), late)
    np.testing.assert_array_equal(error.frame, [3, 4])
    with pytest.raises(TrackerError, match="no frame in common"):
        evaluate_against_truth(known.track(), replace(known.truth, frame=known.truth.frame + 100))


def test_a_truth_of_the_other_hand_is_refused(known):
    names = tuple(name.replace("right", "left") for name in known.truth.joint_names)
    with pytest.raises(TrackerError, match=r"hands \['left'\], the track \['right'\]"):
        evaluate_against_truth(known.track(), replace(known.truth, joint_names=names))

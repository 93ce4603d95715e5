"""Where no joint is marked, the depth itself says how far a fitted hand is off."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.evaluation.depth_distance import measure_depth_distances
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup


@pytest.fixture(scope="module")
def setup(known) -> TrackSetup:
    return TrackSetup(("right",), (known.model,), "cam0", TrackOptions())


def measure(known, setup: TrackSetup, move=(0.0, 0.0, 0.0), max_pixels: int = 2000) -> np.ndarray:
    pose = known.poses[2].copy()
    pose[:3] += move
    return measure_depth_distances(known.sequence, setup, pose, 2, max_pixels)


def test_the_true_pose_lies_within_the_noise_of_the_depth(known, setup: TrackSetup) -> None:
    distances = measure(known, setup)
    assert len(distances) == 2000 and np.median(distances) < 0.001, "m"


def test_a_hand_that_is_20_mm_too_far_is_off_by_less_than_that_and_by_much_more_than_none(known, setup) -> None:
    away = 0.02 * known.sequence.cameras[0].T_world_camera[:3, 2]
    distances = measure(known, setup, away)
    assert 0.006 < np.median(distances) < 0.02 and distances.max() < 0.03
    assert np.median(distances) > 8 * np.median(measure(known, setup))


def test_no_more_pixels_than_asked_for_are_measured_and_they_are_evenly_chosen(known, setup: TrackSetup) -> None:
    many, few = measure(known, setup, max_pixels=10**6), measure(known, setup, max_pixels=50)
    assert len(few) == 50 < len(many)
    assert np.array_equal(few, many[np.linspace(0, len(many) - 1, 50).astype(int)])
    assert len(measure(known, setup, max_pixels=len(many))) == len(many)


def test_what_lies_behind_the_wrist_does_not_count(known, setup: TrackSetup) -> None:
    posed = setup.scene.pose_at(known.poses[2])
    joints = posed.landmarks(0)
    forward = (joints[9] - joints[0]) / np.linalg.norm(joints[9] - joints[0])
    counts = [len(measure(known, setup, step * forward, 10**6)) for step in (0.0, 0.03, 0.06)]
    assert counts[0] > counts[1] > counts[2], "the hand of the image is more and more behind the wrist"


@pytest.mark.parametrize("move", [(0.0, 0.0, 50.0), (50.0, 0.0, 0.0)])
def test_a_hand_out_of_sight_has_no_distances(known, setup: TrackSetup, move: tuple[float, ...]) -> None:
    assert measure(known, setup, move).shape == (0,)

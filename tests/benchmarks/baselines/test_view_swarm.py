"""The swarm before colour cameras, on photographs of a drawn hand."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.baselines.swarm_options import SwarmOptions
from benchmarks.baselines.view_swarm import search_views
from tests.benchmarks.baselines.scenes import seen_hand
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import ViewHands

NO_JOINTS = ViewHands((), ())


@pytest.fixture(scope="module")
def hand():
    return seen_hand()


@pytest.fixture(scope="module")
def setup(hand):
    ids = tuple(camera.id for camera in hand.cameras)
    options = TrackOptions(calibrate=False, cameras=",".join(ids), use_depth=False)
    return TrackSetup(("right",), hand.scene.models, ids[0], options, view_ids=ids)


def test_it_follows_a_hand_that_was_moved(hand, setup):
    start = hand.pose + np.r_[0.012, -0.008, 0.006, np.zeros(len(hand.pose) - 3)]
    found = search_views(setup, NO_JOINTS, hand.photographs(hand.pose), start, SwarmOptions())
    truth = hand.scene.pose_at(hand.pose).landmarks(0)
    before, after = (
        float(np.linalg.norm(hand.scene.pose_at(pose).landmarks(0) - truth, axis=1).mean()) for pose in (start, found)
    )
    assert after < 0.5 * before
    assert np.all(found >= hand.scene.lower) and np.all(found <= hand.scene.upper)


def test_the_same_seed_gives_the_same_bits(hand, setup):
    few = SwarmOptions(particles=8, generations=5)
    found = [search_views(setup, NO_JOINTS, hand.photographs(hand.pose), hand.pose + 0.01, few) for _ in range(2)]
    assert np.array_equal(*found)


def test_a_hand_that_no_view_shows_stays_where_it_was(hand, setup):
    away = hand.pose + np.r_[5.0, np.zeros(len(hand.pose) - 1)]
    found = search_views(setup, NO_JOINTS, hand.photographs(hand.pose), away, SwarmOptions(particles=4, generations=2))
    assert np.array_equal(found, away)

"""A few votes stand for all offsets of a leaf."""

import numpy as np

from tracker.detection.forest import MODES
from tracker.detection.modes import find_modes


def test_two_clusters_become_two_votes_the_larger_first(rng):
    offsets = np.concatenate([rng.normal([4, -2, 7], 0.1, (30, 3)), rng.normal([-5, 1, -7], 0.1, (60, 3))])
    modes = find_modes(offsets.astype(np.float32), 2)
    np.testing.assert_allclose(modes[:, :3], [[-5, 1, -7], [4, -2, 7]], atol=0.1)
    np.testing.assert_allclose(modes[:, 3], [2 / 3, 1 / 3], atol=1e-6)


def test_one_place_needs_one_vote_and_no_offset_none(rng):
    one = find_modes(rng.normal([3, 3, 1], 0.1, (20, 3)).astype(np.float32), MODES)
    np.testing.assert_allclose(one[0], [3, 3, 1, 1], atol=0.1)
    assert not one[1:].any()
    assert not find_modes(np.zeros((0, 3), dtype=np.float32), MODES).any()


def test_shares_sum_to_one(rng):
    modes = find_modes(rng.uniform(-8, 8, (50, 3)).astype(np.float32), MODES)
    assert np.isclose(modes[:, 3].sum(), 1.0)
    assert (np.diff(modes[:, 3]) <= 0).all()

"""The swarm alone, on a cost whose minimum is known."""

from __future__ import annotations

from time import perf_counter

import numpy as np
import pytest

from benchmarks.baselines.swarm import Bounds, search_with_swarm
from benchmarks.baselines.swarm_options import SwarmOptions
from tracker.errors import TrackingError

GOAL = np.array([0.3, -0.2, 0.1, 0.4])
BOUNDS = Bounds(np.full(4, -1.0), np.full(4, 1.0), np.full(4, 0.1), np.array([2, 3]))


def bowl(place: np.ndarray) -> float:
    return float(np.sum((place - GOAL) ** 2))


def test_the_constriction_is_that_of_the_literature():
    assert SwarmOptions().constriction == pytest.approx(0.7298, abs=1e-4)


def test_the_swarm_finds_the_bottom_of_a_bowl(rng):
    found = search_with_swarm(bowl, np.zeros(4), BOUNDS, SwarmOptions(), rng)
    assert np.abs(found.place - GOAL).max() < 1e-2
    assert found.evaluations == 64 * 40
    assert np.all(np.diff(found.history) <= 0.0)


def test_a_bottom_outside_the_box_gives_its_border_and_nothing_outside_is_tried(rng):
    tried = []

    def cost(place: np.ndarray) -> float:
        tried.append(place.copy())
        return float(np.sum((place - 3.0) ** 2))

    found = search_with_swarm(cost, np.full(4, 5.0), BOUNDS, SwarmOptions(particles=16, generations=30), rng)
    assert np.abs(np.array(tried)).max() <= 1.0
    assert np.allclose(found.place, 1.0)


def test_a_late_search_returns_the_start(rng):
    found = search_with_swarm(bowl, np.zeros(4), BOUNDS, SwarmOptions(), rng, deadline=perf_counter())
    assert np.array_equal(found.place, np.zeros(4))
    assert found.evaluations == 1


def test_re_initialised_particles_go_anywhere_within_the_bounds(rng):
    """With no spread and nothing to gain only re-initialisation moves a particle, and only where it may."""
    still = Bounds(BOUNDS.lower, BOUNDS.upper, np.zeros(4), BOUNDS.reset)
    tried = []

    def flat(place: np.ndarray) -> float:
        tried.append(place.copy())
        return 1.0

    search_with_swarm(flat, np.zeros(4), still, SwarmOptions(particles=10, generations=4), rng)
    last = np.array(tried[-10:])
    assert np.all(last[:, :2] == 0.0)
    assert np.count_nonzero(np.any(last != 0.0, axis=1)) == 5
    assert not np.any(tried[:-10])


@pytest.mark.parametrize(
    "wrong",
    [{"particles": 1}, {"generations": 0}, {"seconds_per_frame": 0.0}, {"cognitive": 1.0}, {"reset_share": 1.5}],
)
def test_settings_without_sense_are_refused_by_name(wrong):
    with pytest.raises(TrackingError, match=next(iter(wrong))):
        SwarmOptions(**wrong)

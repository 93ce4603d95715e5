"""Errors that are planted to measure the queue of frames to look at."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.frames_to_look_at import EVERY, KINDS, choose, other_hand, plant

PLACES = [(frame, hand) for frame in range(90) for hand in ("right", "left")]


@pytest.mark.parametrize("seed", range(3))
def test_one_hand_of_ten_gets_an_error_of_every_kind_and_swapped_hands_are_both_wrong(seed: int) -> None:
    planted = choose(PLACES, np.random.default_rng(seed))
    assert len(planted) == len(PLACES) // EVERY
    assert set(planted.values()) == set(KINDS)
    for place, kind in planted.items():
        if kind == "left and right swapped":
            assert planted[other_hand(place)] == kind


def test_a_hand_that_is_alone_is_not_swapped() -> None:
    alone = [(frame, "right") for frame in range(100)]
    assert "left and right swapped" not in choose(alone, np.random.default_rng(0)).values()


def test_a_swapped_hand_is_where_the_other_one_is() -> None:
    rng = np.random.default_rng(1)
    points = {place: rng.normal(size=(21, 3)) for place in PLACES}
    found = plant(points, (7, "left"), "left and right swapped", rng)
    np.testing.assert_array_equal(found, points[7, "right"])
    shifted = plant(points, (7, "left"), "shifted joint", rng)
    assert np.count_nonzero((shifted != points[7, "left"]).any(axis=1)) == 1

"""What is usual is a median and a robust spread: a few wrong values change neither."""

from __future__ import annotations

import numpy as np
import pytest

from server.quality.usual import SPREADS, compare_with_usual, find_usual


def test_the_spread_of_noise_is_its_standard_deviation(rng: np.random.Generator) -> None:
    table = rng.normal([10.0, 50.0], [1.0, 4.0], (20_000, 2))
    usual, spread = find_usual(table)
    assert usual == pytest.approx([10.0, 50.0], rel=0.01) and spread == pytest.approx([1.0, 4.0], rel=0.05)


def test_outliers_and_what_is_not_known_change_little(rng: np.random.Generator) -> None:
    table = rng.normal(10.0, 1.0, (1000, 1))
    usual, spread = find_usual(table)
    table[::20], table[1::20] = 500.0, np.nan
    again, wider = find_usual(table)
    assert again == pytest.approx(usual, abs=0.15) and wider == pytest.approx(spread, rel=0.15)


def test_a_column_of_which_nothing_is_known_has_no_usual() -> None:
    usual, spread = find_usual(np.full((4, 1), np.nan))
    assert np.isnan(usual).all() and np.isnan(spread).all()


def test_only_what_is_far_beyond_the_usual_and_the_least_is_more_than_one() -> None:
    table = np.array([[10.0], [11.0], [9.0], [10.0], [10.0 + SPREADS * 1.4826 + 30.0]])
    over, usual = compare_with_usual(table, np.full(5, 1.0))
    assert usual == [10.0] and (over[:, 0] > 1.0).tolist() == [False] * 4 + [True]
    assert (compare_with_usual(table, np.full(5, 100.0))[0] <= 1.0).all()

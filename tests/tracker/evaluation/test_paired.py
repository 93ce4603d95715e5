"""Two tracks are compared over what both have, and the interval says how sure the difference is."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.evaluation.judged import make_evaluation
from tracker.evaluation.paired import compare_paired, find_common


def test_only_frames_and_joints_that_both_have_are_compared() -> None:
    rng = np.random.default_rng(3)
    first, second = rng.uniform(0, 9, (4, 21)), rng.uniform(0, 9, (4, 21))
    first[1, 5] = np.nan
    second[2, 8] = np.nan
    found = compare_paired([(make_evaluation(first, [0, 1, 2, 3]), make_evaluation(second, [1, 2, 3, 4]))])
    assert found is not None
    pairs = [
        (first[row, joint], second[row - 1, joint])
        for row in (1, 2, 3)
        for joint in range(21)
        if np.isfinite(first[row, joint]) and np.isfinite(second[row - 1, joint])
    ]
    own, other = np.array(pairs).T
    assert (found.joints, found.frames) == (len(pairs), 3)
    assert found.mean == pytest.approx(own.mean())
    assert found.reference_mean == pytest.approx(other.mean())
    assert found.difference == pytest.approx((own - other).mean())
    assert found.better == pytest.approx((own < other).mean())
    assert found.low <= found.difference <= found.high


def test_the_interval_is_that_of_a_plain_bootstrap_over_frames() -> None:
    rng = np.random.default_rng(4)
    first = rng.uniform(0, 9, (40, 21))
    second = first + rng.normal(0.3, 1.0, (40, 1)) + rng.normal(0, 0.1, (40, 21))
    found = compare_paired([(make_evaluation(second), make_evaluation(first))])
    means = [np.mean([np.mean(second[frame] - first[frame]) for frame in rng.integers(0, 40, 40)]) for _ in range(3000)]
    low, high = np.percentile(means, (2.5, 97.5))
    assert found is not None
    width = high - low
    assert found.low == pytest.approx(low, abs=0.12 * width)
    assert found.high == pytest.approx(high, abs=0.12 * width)


def test_the_interval_holds_the_true_difference_as_often_as_it_says() -> None:
    rng = np.random.default_rng(5)
    held = 0
    for _ in range(200):
        base = rng.uniform(2, 9, (60, 21))
        other = base + 0.4 + rng.normal(0, 0.8, (60, 1)) + rng.normal(0, 0.8, (60, 21))
        found = compare_paired([(make_evaluation(other), make_evaluation(base))])
        assert found is not None
        held += found.low <= 0.4 <= found.high
    assert 180 <= held <= 198, "95 % of 200, give or take what chance allows and bootstraps are short of"


def test_recordings_are_pooled_and_their_frames_kept_apart() -> None:
    ones, threes = np.ones((2, 21)), np.full((6, 21), 3.0)
    zeros = [np.zeros((2, 21)), np.zeros((6, 21))]
    found = compare_paired(
        [(make_evaluation(ones), make_evaluation(zeros[0])), (make_evaluation(threes), make_evaluation(zeros[1]))]
    )
    assert found is not None
    assert (found.frames, found.joints) == (8, 8 * 21)
    assert found.difference == pytest.approx((2 * 1 + 6 * 3) / 8)


def test_nothing_in_common_is_no_comparison() -> None:
    ones = np.ones((2, 21))
    assert compare_paired([(make_evaluation(ones, [0, 1]), make_evaluation(ones, [2, 3]))]) is None
    assert compare_paired([]) is None


def test_what_all_have_is_what_none_lacks() -> None:
    errors = [np.full((3, 21), value) for value in (1.0, 2.0, 3.0)]
    errors[2][0, 4] = np.nan
    places = ([0, 1, 2], [1, 2, 3], [1, 5, 2])
    made = [make_evaluation(error, frames) for error, frames in zip(errors, places, strict=True)]
    frames, common = find_common(made)
    assert frames.tolist() == [1, 2]
    assert [np.isnan(one).sum() for one in common] == [1, 1, 1]
    assert [np.nanmax(one) for one in common] == [1.0, 2.0, 3.0]

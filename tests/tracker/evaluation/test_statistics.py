"""The numbers of tables: what is not known is left out, and nothing known is no number at all."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker.evaluation.statistics import compute_shares_below, compute_statistics

ERRORS = hnp.arrays(np.float64, st.integers(1, 40), elements=st.one_of(st.floats(0, 1e4), st.just(np.nan)))


@given(ERRORS)
def test_what_is_not_known_changes_nothing(errors: np.ndarray) -> None:
    known = errors[np.isfinite(errors)]
    found = compute_statistics(errors)
    assert found == compute_statistics(known) and found.count == len(known)
    if found.count:
        assert found.median <= found.p75 <= found.p95 <= found.p99 <= found.max == known.max()
        assert known.min() <= found.mean + 1e-9 and found.mean <= found.max + 1e-9
        assert found.std == pytest.approx(np.sqrt(np.mean((known - known.mean()) ** 2)), abs=1e-6)


def test_without_an_error_there_is_a_count_and_nothing_else() -> None:
    found = compute_statistics(np.full((2, 21), np.nan)).to_json()
    assert found.pop("count") == 0 and set(found.values()) == {None}


@given(ERRORS, hnp.arrays(np.float64, 5, elements=st.floats(0, 1e4)))
def test_shares_are_those_at_most_each_threshold(errors: np.ndarray, thresholds: np.ndarray) -> None:
    shares, known = compute_shares_below(errors, thresholds), errors[np.isfinite(errors)]
    if len(known) == 0:
        assert np.isnan(shares).all()
    else:
        np.testing.assert_allclose(shares, [(known <= threshold).mean() for threshold in thresholds])

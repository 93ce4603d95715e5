"""What a check reads of the labels."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from server.quality.labels import find_median

VALUES = arrays(np.float64, array_shapes(min_dims=2, max_dims=2), elements=st.floats(-1e6, 1e6) | st.just(np.nan))


@pytest.mark.parametrize("axis", [None, 0, 1])
@given(values=VALUES)
def test_the_median_is_that_of_what_is_known(axis: int | None, values: np.ndarray) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        expected = np.nanmedian(values, axis=axis)
    np.testing.assert_allclose(find_median(values, axis), expected, rtol=1e-12)

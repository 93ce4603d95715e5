"""Objects are green and people are not."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tracker.synthesis.scans.colors import paint


@given(st.integers(0, 40), st.integers(0, 2**32 - 1))
def test_green_is_an_object_and_no_skin_of_anybody_is_green(subject, seed) -> None:
    """[R17] 3.1 tells objects by G > max(R, 20)."""
    rng = np.random.default_rng(seed)
    is_object = rng.random(300) < 0.5
    colors = paint(is_object, subject, rng).astype(int)
    is_green = colors[:, 1] > np.maximum(colors[:, 0], 20)
    assert np.array_equal(is_green, is_object)

"""The same arguments arrange the same hand, and what there is not is refused with what there is."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.errors import TrackerError
from tracker.synthesis.scans.arrange import arrange


def test_the_same_arrangement_is_the_same_and_another_side_or_seed_another_moment() -> None:
    (_, name, one), (_, _, same) = (arrange(3, "fist", "right", seed=2) for _ in range(2))
    assert name == "fist" and np.array_equal(one, same)
    for other in (arrange(3, "fist", "left", seed=2), arrange(3, "fist", "right", seed=3), arrange(5, "fist", seed=2)):
        assert not np.array_equal(one, other[2])
    _, _, exact = arrange(3, "fist", is_varied=False)
    assert np.array_equal(exact, arrange(3, "fist", seed=9, is_varied=False)[2])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((1, "fist", "middle"), "'right' or 'left', not 'middle'"),
        ((0, "fist"), "numbered from 1"),
        ((1, np.full(31, np.nan)), "A pose is 31 angles"),
        ((1, "nonsense"), "There is no pose 'nonsense'"),
        ((1, -1), "There is no pose -1"),
    ],
)
def test_what_there_is_not_is_refused_with_what_there_is(arguments, said) -> None:
    with pytest.raises(TrackerError, match=said):
        arrange(*arguments)

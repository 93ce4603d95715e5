"""How far cameras are shifted, as people write it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.frame_shifts import MOST, parse_shifts
from tracker.errors import ImportRefusedError

NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,5}", fullmatch=True)


@given(st.dictionaries(NAMES, st.integers(-MOST, MOST), max_size=4), st.sampled_from([",", ", ", " ", " , "]))
def test_shifts_are_read_as_they_are_written(shifts: dict[str, int], between: str) -> None:
    assert parse_shifts(between.join(f"{name}={frames:+d}" for name, frames in shifts.items())) == shifts


def test_nothing_is_shifted_by_none() -> None:
    assert parse_shifts(" none ") == parse_shifts("") == {}


@pytest.mark.parametrize(
    "text", ["cam1", "cam1=", "=3", "cam1=1.5", "cam1=x", "cam1=1 cam1=2", f"cam1={MOST + 1}", "cam1=" + "9" * 5000]
)
def test_what_is_no_shift_is_named(text: str) -> None:
    with pytest.raises(ImportRefusedError, match=r"cannot be read; needed CAMERA=FRAMES"):
        parse_shifts(text)

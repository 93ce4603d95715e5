"""The time left that a bar tells."""

from __future__ import annotations

import pytest

from server.jobs.pace import Pace


class Clock:
    seconds = 100.0

    def __call__(self) -> float:
        return self.seconds


def test_what_is_left_takes_as_long_as_what_went_by() -> None:
    clock = Clock()
    pace = Pace(clock)
    assert pace.estimate(0.5) is None, "taken up in the middle: nothing has been seen of it yet"
    clock.seconds += 10.0
    assert pace.estimate(0.6) == pytest.approx(40.0)
    clock.seconds += 30.0
    assert pace.estimate(1.0) == 0.0


def test_nothing_is_said_before_there_is_something_to_judge_by() -> None:
    clock = Clock()
    pace = Pace(clock)
    pace.estimate(0.0)
    clock.seconds += 60.0
    assert pace.estimate(0.01) is None, "a bar that hardly moved"
    pace = Pace(clock)
    pace.estimate(0.0)
    clock.seconds += 0.5
    assert pace.estimate(0.4) is None, "one that jumped over what was kept from before"

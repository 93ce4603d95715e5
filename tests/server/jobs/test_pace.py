"""The time left that a bar tells."""

from __future__ import annotations

import uuid
from itertools import pairwise

import pytest

from server.jobs.pace import MOST_PACES, Pace, Paces


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


def run(stages: list[tuple[float, float]], step: float) -> list[tuple[float, float, float | None]]:
    """Share of the time gone by, seconds left in truth and as told, for stages of (share of the bar, seconds)."""
    clock = Clock()
    pace, total, told = Pace(clock), sum(seconds for _, seconds in stages), []
    began, at = clock.seconds, 0.0
    for share, seconds in stages:
        for number in range(round(seconds / step)):
            said = pace.estimate(at + share * number * step / seconds)
            gone = clock.seconds - began
            told.append((gone / total, total - gone, said))
            clock.seconds += step
        at += share
    return told


@pytest.mark.parametrize("step", [0.2, 2.5])
@pytest.mark.parametrize(
    "stages",
    [
        pytest.param([(1.0, 300.0)], id="one stage"),
        pytest.param([(0.3, 90.0), (0.2, 60.0), (0.5, 150.0)], id="stages of known cost"),
        pytest.param([(0.1, 90.0), (0.9, 300.0)], id="a first stage that takes three times its share"),
        pytest.param([(0.5, 40.0), (0.1, 60.0), (0.4, 200.0)], id="each one slower than the one before"),
    ],
)
def test_the_time_left_never_leaps(stages: list[tuple[float, float]], step: float) -> None:
    told = [said for _, _, said in run(stages, step) if said is not None]
    assert len(told) > 50
    for before, after in pairwise(told):
        assert after <= 1.2 * before, "it rose by more than a fifth between two updates"
        assert after >= 0.6 * (before - step) - 1.0, "it fell by more than the time that went by and a bit"


def test_at_constant_speed_it_is_right() -> None:
    for gone, truth, said in run([(0.3, 90.0), (0.2, 60.0), (0.5, 150.0)], 0.2):
        if gone > 0.05:
            assert said == pytest.approx(truth, rel=0.05, abs=1.0)


def test_a_stage_of_another_pace_is_made_up_for() -> None:
    told = run([(0.1, 90.0), (0.9, 300.0)], 0.2)
    late = [(truth, said) for gone, truth, said in told if gone > 0.6]
    assert all(said is not None and said == pytest.approx(truth, rel=0.25, abs=5.0) for truth, said in late)


def test_a_bar_that_would_go_back_stands_still() -> None:
    clock = Clock()
    pace = Pace(clock)
    pace.estimate(0.0)
    clock.seconds += 10.0
    first = pace.estimate(0.5)
    clock.seconds += 1.0
    assert first is not None and (pace.estimate(0.2) or 0.0) <= first, "what is done again was counted before"


def test_the_paces_of_a_job_and_of_a_chunk_of_another_stand_side_by_side_and_old_ones_go() -> None:
    paces, jobs = Paces(), [uuid.uuid4() for _ in range(MOST_PACES + 1)]
    first = paces.find(jobs[0], 1)
    for job in jobs[1:MOST_PACES]:
        assert paces.find(job, 1) is paces.find(job, 1) is not first
    assert paces.find(jobs[0], 1) is first is not paces.find(jobs[0], 2)
    for job in jobs:
        paces.find(job, 3)
    assert paces.find(jobs[0], 1) is not first

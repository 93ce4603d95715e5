"""Whoever waits for a run to begin is told a share that rises from nothing to all, part by part."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from tracker.capture.recorded_object import RecordedObject
from tracker.capture.sequence import Sequence
from tracker.fitting.options import TrackOptions
from tracker.tracking.start_plan import StartPlan, plan_start

BALL, CUBE = RecordedObject("ball", "ball.ply"), RecordedObject("cube", "cube.ply")


def plan(frames: int = 100, objects=(), options: TrackOptions | None = None, hands=()) -> StartPlan:
    recording = Sequence(Path(), "made", 30.0, frames, (), ("right", "left"), objects)
    return plan_start(recording, options or TrackOptions(), hands)


@pytest.mark.parametrize("objects", [(), (BALL,), (BALL, CUBE)])
@pytest.mark.parametrize("calibrate", [True, False])
def test_told_in_order_the_share_rises_from_nothing_to_all_without_a_jump(objects, calibrate):
    made, told = plan(objects=objects, options=TrackOptions(calibrate=calibrate)), []
    tell = made.share(lambda stage, share: told.append((stage, share)))
    for stage, _ in made.parts:
        for share in (0.0, 0.5, 1.0):
            tell(stage, share)
    shares = [share for _, share in told]
    assert shares[0] == 0.0 and shares[-1] == pytest.approx(1.0)
    assert all(later >= earlier - 1e-12 for earlier, later in pairwise(shares))
    for end, begin in pairwise(shares[2:-1]):
        assert begin >= end - 1e-12
    assert [stage for stage, _ in told[::3]] == [stage for stage, _ in made.parts]


def test_every_part_has_a_name_of_its_own_and_takes_time():
    made = plan(objects=(BALL, CUBE))
    names = [name for name, _ in made.parts]
    assert len(set(names)) == len(names)
    assert all(cost > 0.0 for _, cost in made.parts)
    assert made.frames == pytest.approx(sum(cost for _, cost in made.parts))


def test_hands_come_first_in_the_order_in_which_they_are_placed_then_objects():
    names = [name for name, _ in plan(objects=(BALL, CUBE), hands=("left", "right")).parts]
    assert names[:4] == ["placing the left hand", "placing the right hand", "placing ball", "placing cube"]
    assert plan(hands=("left", "right")).frames == plan().frames


def test_without_a_shape_to_fit_only_places_are_left_and_a_short_run_takes_less_than_a_long_one():
    assert len(plan(options=TrackOptions(calibrate=False)).parts) == 2
    lengths = [plan(frames).frames for frames in (1, 5, 20, 50, 60)]
    assert lengths == sorted(lengths) and lengths[0] < lengths[-1]
    assert plan(60).frames == plan(10_000).frames, "the shape is fitted to the first seconds"
    assert plan(10_000, options=TrackOptions(first_frame=9_990)).frames == plan(10).frames

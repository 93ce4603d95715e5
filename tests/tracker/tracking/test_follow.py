"""From frame to frame: in order, told to whoever asks, and the same every time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.search.tools import make_tools
from tracker.tracking.ahead import read_ahead
from tracker.tracking.follow import follow_frame, track_frames


@pytest.fixture(scope="module")
def tools(recorded, run):
    with make_tools(run[0], recorded.sequence.camera("cam0").T_world_camera) as made:
        yield made


def test_frames_are_tracked_in_order_and_not_from_the_middle(recorded, run) -> None:
    setup, start = run[:2]
    with pytest.raises(AssertionError, match="chunks are tracked in order"):
        track_frames(recorded.sequence, setup, start, range(3, 5))


def test_each_frame_is_told_with_its_result_and_whoever_is_told_may_end_the_run(recorded, run) -> None:
    setup, start, _, whole = run
    told = []

    def tell(index, result) -> None:
        told.append((index, result))
        if index == 1:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        track_frames(recorded.sequence, setup, start, range(4), tell)
    assert [index for index, _ in told] == [result.frame for _, result in told] == [0, 1]
    np.testing.assert_array_equal([result.pose for _, result in told], whole.pose[:2])


@pytest.fixture(scope="module")
def followed(recorded, run, tools):
    """The states after the first two frames, each followed alone."""
    setup, start = run[:2]
    first, _ = follow_frame(recorded.sequence, setup, tools, start, recover=True)
    second, _ = follow_frame(recorded.sequence, setup, tools, first, recover=True)
    return first, second


def test_a_frame_alone_is_what_it_is_in_a_run_that_reads_ahead(recorded, run, tools, followed) -> None:
    setup, _, _, whole = run
    np.testing.assert_array_equal([state.pose for state in followed], whole.pose[:2])
    before = followed[0].pose.copy()
    with read_ahead(recorded.sequence, setup, 2) as ahead:
        _, again = follow_frame(recorded.sequence, setup, tools, followed[0], True, ahead)
    np.testing.assert_array_equal(again.pose, whole.pose[1])
    np.testing.assert_array_equal(followed[0].pose, before)


def test_the_state_after_a_frame_waits_for_the_next_and_knows_the_two_last_poses(run, followed) -> None:
    first, second = followed
    assert (first.next_frame, second.next_frame) == (1, 2)
    assert not second.is_lost and second.gone_hands(run[0]) == ()
    np.testing.assert_array_equal(second.earlier_pose, first.pose)


def test_a_hand_that_is_far_from_where_it_was_left_is_lost_where_nobody_looks_for_it(recorded, run, tools) -> None:
    setup, start = run[:2]
    aside = setup.scene.retract(start.pose, np.r_[0.15, 0.0, 0.0, np.zeros(setup.scene.num_dofs - 3)])
    astray = replace(start, next_frame=1, pose=aside, earlier_pose=aside, detected={})
    blind = replace(setup, options=replace(setup.options, use_detector=False, iterations=2))
    state, result = follow_frame(recorded.sequence, blind, tools, astray, recover=False)
    assert result.status == "lost" and result.hand_status == ("lost",)
    assert state.is_lost and state.gone_hands(setup) == (0,)
    np.testing.assert_array_equal(state.pose, result.pose)


def test_a_frame_tells_what_its_time_went_to(run) -> None:
    _, _, _, whole = run
    names = [str(name) for name in whole.stage_names]
    assert {"reading", "detecting hands", "searching the image"} <= set(names)
    assert (whole.stages >= 0.0).all() and (whole.seconds > 0.0).all()
    assert (whole.stages[:, names.index("detecting hands")] <= whole.seconds).all()

"""Hands are calibrated in two passes, told stage by stage, from frames that show them and from no others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.tracking.calibration_run import PASSES, calibrate_hands, name_pass


def test_stages_are_named_for_people_with_their_pass() -> None:
    assert [name_pass("following", number) for number in (1, 2)] == ["following (1 of 2)", "following (2 of 2)"]


def test_the_second_pass_goes_farther_and_takes_more_frames_than_the_first() -> None:
    first, second = PASSES
    assert first.followed < second.followed and first.fitted < second.fitted
    assert all(each.fitted <= each.followed for each in PASSES)
    assert first.options.rounds < second.options.rounds


@pytest.fixture(scope="module")
def calibrated(recorded, run):
    """From one frame; what was told meanwhile."""
    told: list[tuple[str, float]] = []
    setup, start = run[:2]
    found = calibrate_hands(recorded.sequence, setup, range(1), start.pose, lambda *what: told.append(what))
    return *found, told


@pytest.mark.slow
def test_each_stage_of_each_pass_is_told_in_order_up_to_its_end(calibrated) -> None:
    told = calibrated[2]
    stages = list(dict.fromkeys(stage for stage, _ in told))
    assert stages == [name_pass(what, number) for number in (1, 2) for what in ("following", "fitting the shape")]
    for stage in stages:
        shares = [share for name, share in told if name == stage]
        assert shares == sorted(shares) and shares[-1] == pytest.approx(1.0)


@pytest.mark.slow
def test_the_hand_that_was_drawn_stays_nearly_as_it_is_and_where_it_is(calibrated, recorded, run) -> None:
    setup, pose, _ = calibrated
    given = run[0]
    assert (setup.names, setup.options, setup.camera_id) == (given.names, given.options, given.camera_id)
    assert setup.models[0] is not given.models[0] and len(pose) == given.scene.num_dofs
    apart = setup.scene.pose_at(pose).landmarks(0) - recorded.truth.joints_3d[0]
    assert np.linalg.norm(apart, axis=1).mean() < 0.003  # m


def test_from_frames_that_show_no_hand_in_its_place_nothing_is_learnt(recorded, run) -> None:
    setup, start = run[:2]
    hasty = replace(setup.options, use_detector=False, iterations=1, first_iterations=1)
    blind = replace(setup, options=hasty, marks={})
    away = setup.scene.retract(start.pose, np.r_[0.15, 0.0, 0.0, np.zeros(setup.scene.num_dofs - 3)])
    told: list[str] = []
    found, pose = calibrate_hands(recorded.sequence, blind, range(1), away, lambda stage, share: told.append(stage))
    assert found is blind and told == [name_pass("following", 1)]
    np.testing.assert_array_equal(pose, away)

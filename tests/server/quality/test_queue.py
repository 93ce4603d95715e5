"""The queue holds every hand once, the worst first, and leaves out what a person has answered."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from server.quality.doubt import Doubt, doubt_label
from server.quality.finding import Finding
from server.quality.queue import is_by_hand, queue_hands
from tests.server.quality.drawn_hands import label


def doubt(kind="fit", score=2.0, frame=0, hand="right", camera="cam0", **more) -> Doubt:
    return Doubt(frame, hand, kind, score, camera, (), f"{kind} of {camera}", **more)


def test_doubts_about_one_hand_are_one_entry_and_agreement_counts_more() -> None:
    [one] = queue_hands([doubt("fit", 3.0), doubt("depth", 4.0, camera="")], [])
    assert one.score == pytest.approx(5.0) and [told.kind for told in one.doubts] == ["depth", "fit"]


def test_each_kind_counts_once_by_its_worst() -> None:
    [one] = queue_hands([doubt("fit", 3.0), doubt("fit", 2.0, camera="cam1")], [])
    assert one.score == 3.0 and [told.camera for told in one.doubts] == ["cam0"]


def test_what_hardly_looks_wrong_is_told_only_where_nothing_else_is() -> None:
    [one] = queue_hands([doubt("fit", 0.9), doubt("depth", 0.5, camera="")], [])
    assert [told.kind for told in one.doubts] == ["fit"] and one.score == pytest.approx(0.9)
    [one] = queue_hands([doubt("fit", 0.9), doubt("depth", 1.5, camera="")], [])
    assert [told.kind for told in one.doubts] == ["depth"]


def test_the_worst_hand_comes_first_and_of_equal_ones_the_earlier() -> None:
    found = queue_hands([doubt(frame=7), doubt(frame=3), doubt(frame=9, score=5.0), doubt(frame=3, hand="left")], [])
    assert [(one.frame, one.hand) for one in found] == [(9, "right"), (3, "left"), (3, "right"), (7, "right")]


def test_where_a_person_placed_the_hand_only_the_label_check_speaks() -> None:
    mine = label()
    flag = doubt_label(Finding(mine, "jump", 2.0, (8,), "It jumps."))
    [one] = queue_hands([doubt("fit"), doubt("left_out"), doubt("depth", camera=""), flag], [mine])
    assert [(told.kind, told.flag, told.joints) for told in one.doubts] == [("flag", "jump", (8,))]


def test_a_label_that_was_accepted_from_a_track_answers_for_its_fit_alone() -> None:
    accepted = label(is_independent=False)
    [one] = queue_hands([doubt("fit"), doubt("label", 1.5), doubt("depth", 1.2, camera="")], [accepted])
    assert {told.kind for told in one.doubts} == {"label", "depth"}


def test_a_label_answers_for_its_own_camera_and_frame() -> None:
    found = queue_hands([doubt(camera="cam1"), doubt(frame=1)], [label()])
    assert [(one.frame, one.doubts[0].camera) for one in found] == [(0, "cam1"), (1, "cam0")]


def test_a_label_is_by_hand_when_no_placed_joint_came_from_the_program() -> None:
    assert is_by_hand(label()) and not is_by_hand(label(is_independent=False))
    assert not is_by_hand(label(np.full((21, 2), np.nan)))
    mixed = np.arange(21) != 8
    assert not is_by_hand(replace(label(), is_independent=mixed))

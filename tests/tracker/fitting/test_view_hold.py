"""Hands are held by joints where few views tell all of them, else by contours and the frame before."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import joints, look_from, see
from tracker.fitting.view_hands import ViewHands
from tracker.fitting.view_hold import BY_CONTOURS, BY_FEW_CONTOURS, BY_JOINTS, MANY, choose_hold

__all__ = ["joints"]


def told_in(joints, rng, views: int) -> ViewHands:
    return see(joints, [look_from(0.4 * number) for number in range(views)], rng)


@pytest.mark.parametrize("views", range(1, MANY))
def test_few_views_that_tell_all_joints_hold_by_them(joints, rng, views):
    assert choose_hold(told_in(joints, rng, views)) == BY_JOINTS


def test_few_views_that_tell_half_of_the_joints_hold_by_contours(joints, rng):
    seen = told_in(joints, rng, 2)
    for hands in seen.hands:
        hands["right"].points[::2] = np.nan
    assert choose_hold(seen) == BY_FEW_CONTOURS


def test_a_view_that_sees_no_hand_tells_nothing_of_how_many_joints_are_told(joints, rng):
    seen = told_in(joints, rng, 2)
    assert choose_hold(ViewHands(seen.cameras, (seen.hands[0], {}))) == BY_JOINTS
    assert choose_hold(ViewHands(seen.cameras, ({}, {}))) == BY_JOINTS


def test_many_views_hold_by_contours_whatever_they_tell(joints, rng):
    assert choose_hold(told_in(joints, rng, MANY)) == BY_CONTOURS

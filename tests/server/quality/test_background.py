"""Joints where no hand is: in the empty part of an image, without depth, or on what lies behind the hand."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from server.quality.background import BEHIND_M, LARGE_HAND, LEAST_BONES, check_background
from server.quality.finding import Finding, Looked
from server.quality.labels import Label
from tests.server.quality.drawn_hands import FAR_M, cameras, draw_hand, label

FARTHEST = LARGE_HAND * FAR_M + BEHIND_M
"""m; the drawn hand lies at one depth, so each of its bones says the same."""


def check(one: Label) -> list[Finding]:
    return list(check_background([one], cameras(1), Looked()))


def shift(one: Label, **distances: dict[int, float]) -> Label:
    """The label with some joints this far, px, from content or depth; the others on it."""
    around = one.around
    for name, joints in distances.items():
        values = np.zeros(21)
        values[list(joints)] = list(joints.values())
        around = replace(around, **{name: values})
    return replace(one, around=around)


def test_a_hand_at_its_own_depth_raises_nothing_and_was_looked_at() -> None:
    one, looked = label(), Looked()
    assert list(check_background([one], cameras(1), looked)) == [] and looked.find("background") == {one.id}


def test_a_label_with_neither_depth_nor_an_empty_background_is_not_looked_at() -> None:
    one, looked = label(depths=np.nan), Looked()
    assert list(check_background([one], cameras(1), looked)) == [] and looked.find("background") == frozenset()


@pytest.mark.parametrize(
    ("name", "share", "least", "words"),
    [
        ("to_content", 0.05, 6.0, "anything that this image shows"),
        ("to_depth", 0.15, 12.0, "the nearest depth, though it is marked as visible"),
    ],
)
def test_a_joint_may_lie_beside_the_hand_by_a_share_of_its_size(name, share, least, words) -> None:
    one = label()
    limit = share * one.size_px
    assert limit > least, "the drawn hand is large"
    assert check(shift(one, **{name: {8: limit}})) == []
    [found] = check(shift(one, **{name: {8: 2.0 * limit}}))
    assert (found.kind, found.joints) == ("background", (8,)) and found.score == pytest.approx(2.0)
    assert found.reason == f"The index tip is {2.0 * limit:.0f} px from {words}."


@pytest.mark.parametrize(("name", "least"), [("to_content", 6.0), ("to_depth", 12.0)])
def test_beside_a_tiny_hand_a_few_pixels_are_still_nothing(name: str, least: float) -> None:
    tiny = label(320.0 + 0.01 * (draw_hand() - 320.0), depths=np.nan)
    assert check(shift(tiny, **{name: {8: least}})) == []
    assert len(check(shift(tiny, **{name: {8: least + 0.1}}))) == 1


@pytest.mark.parametrize(
    ("others", "told"), [(0, "shows."), (1, "; so is 1 other joint."), (3, "; so are 3 other joints.")]
)
def test_the_worst_joint_is_named_and_the_others_counted(others: int, told: str) -> None:
    far = {8: 300.0} | dict.fromkeys(range(9, 9 + others), 200.0)
    [found] = check(shift(label(), to_content=far))
    assert found.joints == tuple(sorted(far)) and found.reason.startswith("The index tip is 300 px")
    assert found.reason.endswith(told)


def test_a_score_ends_at_ten() -> None:
    [found] = check(shift(label(), to_content={8: 1e5}))
    assert found.score == 10.0


def test_two_joints_behind_what_the_bones_allow_are_on_the_background() -> None:
    depths = np.full(21, FAR_M)
    depths[[8, 12]] = FARTHEST + 0.01, FARTHEST + 0.3
    [found] = check(label(depths=depths))
    assert found.joints == (8, 12) and found.score == pytest.approx(2.0)
    assert found.reason.startswith("The depth at the middle tip is ")
    assert found.reason.endswith(" m away: is it on the background?")
    told = [float(number) for number in re.findall(r"(\d\.\d\d) m", found.reason)]
    assert told == pytest.approx([FARTHEST + 0.3, FARTHEST], abs=0.006)


def test_one_joint_behind_is_left_to_the_comparison_with_its_neighbours() -> None:
    depths = np.full(21, FAR_M)
    depths[8] = 5.0
    assert check(label(depths=depths)) == []
    depths[12] = FARTHEST - 0.001
    assert check(label(depths=depths)) == []


def test_of_the_depths_around_a_joint_the_nearest_counts() -> None:
    one = label(depths=np.full(21, 5.0))
    near = one.around.depths.copy()
    near[:, 0] = FAR_M  # beside the silhouette most pixels show the wall
    assert check(replace(one, around=replace(one.around, depths=near))) == []
    assert len(check(one)) == 1


@pytest.mark.parametrize(("bones", "is_judged"), [(LEAST_BONES - 1, False), (LEAST_BONES, True)])
def test_how_far_away_a_hand_is_takes_enough_bones_to_tell(bones: int, is_judged: bool) -> None:
    pixels = draw_hand()
    pixels[bones + 1 :] = np.nan
    assert bool(check(label(pixels, depths=np.where(np.isfinite(pixels[:, 0]), 5.0, np.nan)))) == is_judged

"""Checks of a label by itself: a good one raises none, and each mistake is named with its joints."""

from __future__ import annotations

import numpy as np
import pytest

from server.quality.finding import Looked
from server.quality.hand import KNUCKLES
from server.quality.one_label import check_depth, check_finger_order, check_outside
from tests.server.quality.drawn_hands import FAR_M, HEIGHT, WIDTH, draw_hand, label

SIZES = {"cam0": (WIDTH, HEIGHT)}


def test_a_good_label_raises_nothing_and_every_check_looked_at_it() -> None:
    good, looked = label(), Looked()
    assert list(check_outside([good], SIZES, looked)) == []
    assert list(check_finger_order([good], looked)) == []
    assert list(check_depth([good], looked)) == []
    for kind in ("outside", "finger_order", "depth"):
        assert looked.find(kind) == {good.id}


@pytest.mark.parametrize(("place", "px"), [((-20.5, 9.0), 20), ((650.5, 9.0), 11), ((9.0, -3.5), 3), ((9.0, 480.5), 1)])
def test_a_joint_outside_its_image_is_named_with_how_far(place: tuple[float, float], px: int) -> None:
    pixels = draw_hand()
    pixels[8] = place
    [found] = check_outside([label(pixels)], SIZES, Looked())
    assert found.joints == (8,) and f"index tip lies {px} px outside" in found.reason
    assert found.score == pytest.approx(1.0 + px / 20.0)


def test_a_pixel_at_the_border_is_inside_to_its_outer_edge() -> None:
    pixels = draw_hand()
    pixels[8], pixels[12] = (-0.5, -0.5), (WIDTH - 0.5, HEIGHT - 0.5)
    assert list(check_outside([label(pixels)], SIZES, Looked())) == []


def test_joints_of_a_finger_in_the_wrong_order_are_found() -> None:
    pixels = draw_hand()
    pixels[[6, 7]] = pixels[[7, 6]]
    [found] = check_finger_order([label(pixels)], Looked())
    assert found.joints == (5, 6, 7, 8) and "index goes back and forth" in found.reason


def test_swapped_knuckles_are_named_by_their_fingers() -> None:
    pixels = draw_hand()
    swapped = [*range(9, 13), *range(13, 17)]
    pixels[swapped] = pixels[[*range(13, 17), *range(9, 13)]]
    [found] = check_finger_order([label(pixels)], Looked())
    assert found.joints == (9, 13) and "middle and ring" in found.reason


def test_a_fist_whose_joints_lie_together_is_not_judged_by_their_order(rng: np.random.Generator) -> None:
    fist = np.array([320.0, 240.0]) + rng.uniform(-1.0, 1.0, (21, 2))
    assert list(check_finger_order([label(fist)], Looked())) == []


def test_a_finger_with_a_joint_missing_is_not_judged() -> None:
    pixels, looked = np.full((21, 2), np.nan), Looked()
    pixels[5:8] = draw_hand()[[5, 7, 6]]
    one = label(pixels)
    assert list(check_finger_order([one], looked)) == [] and looked.find("finger_order") == frozenset()


def test_a_joint_on_the_wall_behind_is_found_by_its_depth() -> None:
    depths = np.full(21, FAR_M)
    depths[8] = 1.2
    [found] = check_depth([label(depths=depths)], Looked())
    assert found.joints == (8,) and "index tip is 700 mm from the joint beside it" in found.reason


def test_a_finger_that_points_at_the_camera_is_no_mistake() -> None:
    depths = np.full(21, FAR_M)
    depths[[5, 6, 7, 8]] -= [0.0, 0.03, 0.05, 0.07]
    assert list(check_depth([label(depths=depths)], Looked())) == []


def test_without_depth_nothing_is_said_of_it() -> None:
    one, looked = label(depths=np.nan), Looked()
    assert list(check_depth([one], looked)) == [] and looked.find("depth") == frozenset()


def test_knuckles_are_the_joints_at_the_bases_of_four_fingers() -> None:
    from tracker import HAND_JOINTS

    assert [HAND_JOINTS[joint] for joint in KNUCKLES] == ["index_mcp", "middle_mcp", "ring_mcp", "little_mcp"]

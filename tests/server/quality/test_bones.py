"""Bones of a label against the hand's own, in space where there is depth, and in the image without."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from server.quality.bones import LARGEST, SMALLEST, check_bone_lengths, limit_bones
from server.quality.finding import Looked
from server.quality.hand import find_bone_lengths
from tests.server.quality.drawn_hands import K, draw_hand, label

CAMERAS: dict[str, Any] = {"cam0": SimpleNamespace(K=K)}
INDEX_TIP = np.array([60.0, -60.0])


def test_a_hand_as_it_is_raises_nothing() -> None:
    labels, looked = [label(frame=frame) for frame in range(6)], Looked()
    assert list(check_bone_lengths(labels, CAMERAS, looked)) == []
    assert looked.find("bone_length") == {one.id for one in labels}


def test_a_tip_far_from_its_finger_is_found_in_space_with_both_lengths() -> None:
    wrong = draw_hand()
    wrong[8] += INDEX_TIP
    labels = [*(label(frame=frame) for frame in range(6)), label(wrong, 6)]
    [found] = check_bone_lengths(labels, CAMERAS, Looked())
    assert found.label.frame == 6 and found.joints == (7, 8) and found.score > 1
    assert found.reason.startswith("Index dip to index tip is ") and "it usually is" in found.reason


def test_without_depth_a_bone_is_held_against_the_others_of_the_hand() -> None:
    wrong = draw_hand()
    wrong[8] += 2 * INDEX_TIP
    good, bad = label(depths=np.nan), label(wrong, 1, depths=np.nan)
    [found] = check_bone_lengths([good, bad], CAMERAS, Looked())
    assert found.label is bad and found.joints == (7, 8) and "times as long as the other bones" in found.reason


def test_a_finger_that_looks_short_may_point_at_the_camera() -> None:
    pixels = draw_hand()
    pixels[6:9] = pixels[5] + 0.1 * (pixels[6:9] - pixels[5])
    assert list(check_bone_lengths([label(pixels, depths=np.nan)], CAMERAS, Looked())) == []


def test_few_bones_without_depth_are_not_judged() -> None:
    pixels, looked = np.full((21, 2), np.nan), Looked()
    pixels[5:9] = draw_hand()[5:9]
    assert list(check_bone_lengths([label(pixels, depths=np.nan)], CAMERAS, looked)) == []
    assert looked.find("bone_length") == frozenset()


def test_the_usual_length_is_the_recordings_own_within_what_hands_have() -> None:
    lengths = find_bone_lengths()
    for factor, expected in ((1.1, 1.1), (9.0, LARGEST), (0.1, SMALLEST)):
        usual, limit = limit_bones(np.tile(factor * lengths, (6, 1)))
        assert np.allclose(usual, expected * lengths) and (limit >= 0.015).all()
    few, _ = limit_bones(np.tile(1.3 * lengths, (4, 1)))
    assert np.allclose(few, lengths), "four labels say little"

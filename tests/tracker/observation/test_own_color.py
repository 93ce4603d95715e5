"""Pixels of a hand's own colour, in an image drawn for it: a hand before a room, behind a box, in a sleeve."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from tracker.observation.own_color import find_own_color

SKIN, SHADED, BOX, WARM_BOX, SLEEVE = (196, 140, 120), (150, 100, 84), (225, 222, 216), (214, 202, 188), (30, 60, 140)
FOCAL = 240.0


@pytest.fixture
def scene(rng):
    """An upright hand with five fingers, a white box over its palm, partly in a warm light, and a blue sleeve below."""
    knuckles = [(110, 120), (125, 105), (140, 102), (155, 105), (168, 112)]
    tips = [(80, 95), (118, 50), (140, 42), (162, 50), (184, 70)]
    joints = [(140.0, 170.0)]
    color = np.full((240, 320, 3), 12, dtype=np.uint8)
    truth = np.zeros((240, 320), dtype=np.uint8)
    cv2.fillConvexPoly(truth, np.array([*knuckles, (165, 172), (118, 172)], dtype=np.int32), 1)
    for knuckle, tip in zip(knuckles, tips, strict=True):
        cv2.line(truth, knuckle, tip, 1, 11)
        joints += [tuple(np.array(knuckle) + share * np.subtract(tip, knuckle)) for share in (0.0, 0.4, 0.7, 0.95)]
    color[truth > 0] = SKIN
    color[150:, 160:][truth[150:, 160:] > 0] = SHADED
    box = np.zeros_like(truth)
    cv2.fillConvexPoly(box, np.array([(112, 115), (150, 100), (172, 150), (130, 165)], dtype=np.int32), 1)
    color[box > 0] = BOX
    color[(box > 0) & (np.arange(320) > 145)] = WARM_BOX
    truth[box > 0] = 0
    color[172:, 115:168] = SLEEVE
    depth = np.where((color.max(axis=2) > 20), 0.5, 0.0).astype(np.float32)
    noisy = np.clip(color + rng.normal(scale=5.0, size=color.shape), 0, 255).astype(np.uint8)
    return noisy, depth, np.array(joints), truth > 0, box > 0


def test_what_a_hand_holds_and_wears_is_not_of_the_hand(scene):
    color, depth, joints, truth, box = scene
    found = find_own_color(color, depth, joints, FOCAL)
    assert found[truth].mean() > 0.95
    assert found[box].mean() < 0.05
    assert found[175:].mean() == 0.0


def test_where_no_depth_is_nothing_is_of_the_hand(scene):
    color, depth, joints, truth, _ = scene
    depth[:, :140] = 0.0
    found = find_own_color(color, depth, joints, FOCAL)
    assert not found[:, :140].any()
    assert found[truth & (depth > 0)].mean() > 0.9


@pytest.mark.parametrize("place", [(-500.0, 0.0), (0.0, 400.0), (1e6, 1e6)])
def test_joints_beside_the_image_find_nothing(scene, place):
    color, depth, joints, _, _ = scene
    assert not find_own_color(color, depth, joints + place, FOCAL).any()


def test_in_an_image_without_colours_a_hand_is_what_lies_about_its_joints(scene):
    color, depth, joints, truth, _ = scene
    grey = np.repeat(color.mean(axis=2, keepdims=True).astype(np.uint8), 3, axis=2)
    far_away = np.zeros_like(truth)
    far_away[:40, :40] = True
    depth[far_away] = 0.5
    found = find_own_color(grey, depth, joints, FOCAL)
    assert found[truth].mean() > 0.9
    assert not found[far_away].any()

"""Noise of colour views: as much of it as was asked for, where it may be, and the same again for the same seed."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tracker.synthesis.view_noise import ViewNoise, disturb_image, disturb_joints

GREY = np.full((1080, 1920, 3), 128, dtype=np.uint8)


def test_discs_cover_about_the_area_they_should_and_change_nothing_else():
    noise = ViewNoise()
    image, is_covered = disturb_image(GREY, noise, np.random.default_rng(1))
    assert np.all(image[~is_covered] == 128)
    expected = noise.circles * np.pi * np.mean(np.linspace(noise.smallest, noise.largest, 1000) ** 2) / is_covered.size
    assert 0.7 * expected < is_covered.mean() < 1.1 * expected
    assert set(np.unique(image[:, :, 0])) >= {68, 128, 188}
    brighter, darker = np.count_nonzero(image > 128), np.count_nonzero(image < 128)
    assert 0.5 < brighter / darker < 2.0


@pytest.mark.parametrize("radius", [10.0, 30.0])
def test_a_disc_has_its_radius(radius):
    noise = ViewNoise(circles=1, smallest=radius, largest=radius)
    for seed in range(20):
        _, is_covered = disturb_image(GREY, noise, np.random.default_rng(seed))
        _, _, width, height = cv2.boundingRect(is_covered.astype(np.uint8))
        if min(width, height) >= 2 * radius - 1:
            assert is_covered.sum() == pytest.approx(np.pi * radius**2, rel=0.05)
            return
    raise AssertionError("no disc lay wholly in the image")


def test_the_same_seed_disturbs_alike_and_another_differently():
    noise, points = ViewNoise(), np.full((50, 2), 300.0)
    visible = np.ones(50, dtype=bool)
    first, again, other = (np.random.default_rng(seed) for seed in (5, 5, 6))
    images = [disturb_image(GREY, noise, rng)[0] for rng in (first, again, other)]
    np.testing.assert_array_equal(images[0], images[1])
    assert np.any(images[0] != images[2])
    joints = [disturb_joints(points, visible, noise, rng) for rng in (first, again, other)]
    np.testing.assert_array_equal(joints[0], joints[1])
    assert not np.array_equal(joints[0], joints[2], equal_nan=True)


def test_detections_are_deleted_moved_and_scattered_as_often_as_they_should_be():
    noise, count = ViewNoise(detected=0.6), 20_000
    points = np.random.default_rng(0).uniform(0.0, 1000.0, (count, 2))
    visible = np.arange(count) % 2 == 0
    found = disturb_joints(points, visible, noise, np.random.default_rng(2))
    is_there = np.isfinite(found).all(axis=1)
    assert not is_there[~visible].any()
    assert is_there[visible].mean() == pytest.approx(0.6, abs=0.02)
    off = found[is_there] - points[is_there]
    apart = np.linalg.norm(off, axis=1)
    assert apart.max() < noise.reach
    is_false = apart > 25.0  # five standard deviations; of the false ones 1 in 64 lies nearer
    assert is_false.mean() == pytest.approx(0.1 * (1.0 - 1.0 / 64.0), abs=0.01)
    assert off[~is_false].std() == pytest.approx(5.0, abs=0.15)


def test_without_noise_joints_stay_where_they_are():
    exact = replace(ViewNoise(), detected=1.0, false=0.0, sigma=0.0)
    points = np.arange(42.0).reshape(21, 2)
    found = disturb_joints(points, np.ones(21, dtype=bool), exact, np.random.default_rng(3))
    np.testing.assert_array_equal(found, points)

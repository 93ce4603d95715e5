"""Random hands: the same for the same seed, sound images, fingertips where they are seen."""

from dataclasses import replace

import numpy as np
import pytest

from tracker.synthesis.fingertip_images import render_fingertip_images
from tracker.synthesis.random_hands import RandomHands, render_random_image


@pytest.fixture(scope="module")
def images():
    return [render_random_image(RandomHands(), np.random.default_rng([5, number])) for number in range(12)]


def test_the_same_seed_makes_the_same_image_and_another_another(images):
    again = render_random_image(RandomHands(), np.random.default_rng([5, 0]))
    for name in ("depth", "color", "is_hand", "tips", "is_visible"):
        assert getattr(again, name).tobytes() == getattr(images[0], name).tobytes()
    assert images[1].depth.tobytes() != images[0].depth.tobytes()


def test_fingertips_lie_in_the_image_and_visible_ones_next_to_a_hand(images):
    seen = 0
    for image in images:
        height, width = image.depth.shape
        assert image.color.shape == (height, width, 3)
        assert ((image.tips >= -0.5) & (image.tips <= [width - 0.5, height - 0.5])).all()
        rows, columns = np.nonzero(image.is_hand)
        for x, y in image.tips[image.is_visible]:
            assert np.hypot(columns - x, rows - y).min() < 4.0
            seen += 1
        known = image.depth[image.depth > 0]
        assert known.min() > 0.1
        np.testing.assert_allclose(known * 1000, np.rint(known * 1000), atol=1e-3)
    assert seen > 25


def test_one_hand_has_five_fingertips_and_two_hands_ten():
    alone = replace(RandomHands(), two_hands=0.0, thing=0.0)
    both = replace(RandomHands(), two_hands=1.0, thing=0.0)
    for number in range(4):
        rng = np.random.default_rng([6, number])
        assert len(render_random_image(alone, rng).tips) <= 5
    assert max(len(render_random_image(both, np.random.default_rng([6, n])).tips) for n in range(4)) == 10


def test_things_are_no_hand():
    with_thing = replace(RandomHands(), two_hands=0.0, thing=1.0)
    image = next(
        image
        for image in (render_random_image(with_thing, np.random.default_rng([7, n])) for n in range(20))
        if ((image.depth > 0) & ~image.is_hand).sum() > 200
    )
    thing = image.color[(image.depth > 0) & ~image.is_hand].mean(axis=0)
    hand = image.color[(image.depth > 0) & image.is_hand].mean(axis=0)
    assert hand[0] > thing[0] + 20


def test_images_to_learn_from_hold_hand_pixels_in_a_narrow_frame():
    for item in render_fingertip_images(6, 3):
        assert item.image.mask.any()
        assert (item.image.depth[item.image.mask] > 0).all()
        assert item.image.color is not None
        assert item.image.color.shape[:2] == item.image.depth.shape
        assert (item.region.height, item.region.width) == item.image.depth.shape
        assert len(item.tips) == len(item.is_visible)

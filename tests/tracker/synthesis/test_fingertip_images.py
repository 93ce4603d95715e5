"""Images to learn fingertips from are what was rendered, cut to its hands; half of them show nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.synthesis.fingertip_images import MARGIN, render_fingertip_images
from tracker.synthesis.random_hands import RandomHands, render_random_image

SEED = 4
SMALL = RandomHands(small_camera=1.0, two_hands=0.0)


@pytest.fixture(scope="module")
def pairs() -> list:
    """Each image beside the rendering that it was cut from."""
    found = []
    for image in render_fingertip_images(4, SEED, SMALL):
        number = int(image.name.split()[1])
        found.append((image, render_random_image(SMALL, np.random.default_rng([SEED, number]))))
    return found


def test_the_part_is_the_box_of_the_hand_with_its_margin_within_the_image(pairs) -> None:
    for image, rendered in pairs:
        rows, columns = np.nonzero(rendered.is_hand & (rendered.depth > 0.0))
        region = image.region
        assert (region.row, region.column) == (max(0, rows.min() - MARGIN), max(0, columns.min() - MARGIN))
        assert region.row + region.height == min(rendered.camera.height, rows.max() + MARGIN + 1)
        assert region.column + region.width == min(rendered.camera.width, columns.max() + MARGIN + 1)


def test_colour_and_fingertips_are_those_of_the_rendering_counted_from_the_part(pairs) -> None:
    for image, rendered in pairs:
        region = image.region
        inside = (slice(region.row, region.row + region.height), slice(region.column, region.column + region.width))
        np.testing.assert_array_equal(image.image.color, rendered.color[inside])
        np.testing.assert_allclose(rendered.tips - (region.column, region.row), image.tips, atol=1e-9)
        np.testing.assert_array_equal(image.is_visible, rendered.is_visible)


def test_depth_is_that_of_the_rendering_or_of_its_hands_alone(pairs) -> None:
    alone = []
    for image, rendered in pairs:
        region = image.region
        inside = (slice(region.row, region.row + region.height), slice(region.column, region.column + region.width))
        is_seen, is_hand = rendered.depth[inside] > 0.0, rendered.is_hand[inside]
        has_depth = image.image.depth > 0.0
        alone.append(np.array_equal(has_depth, is_seen & is_hand))
        assert alone[-1] or np.array_equal(has_depth, is_seen)
        apart = np.abs(image.image.depth - rendered.depth[inside])[has_depth]
        assert np.median(apart) < 0.002, "smoothed by the bilateral filter"
    assert sum(alone) > 0, "some show nothing but hands"


def test_hands_so_far_away_that_hardly_a_pixel_shows_them_give_no_image() -> None:
    assert list(render_fingertip_images(3, SEED, RandomHands(nearest=9.0, farthest=9.5, small_camera=1.0))) == []
    assert list(render_fingertip_images(0, SEED)) == []

"""Images to learn from: of the same number the same, cut to the hands, and marked where a hand's surface really is."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.synthesis.fingertip_images import render_fingertip_images
from tracker.synthesis.nail_images import NEAR_ENOUGH, random_texture, render_nail_images

RENDERERS = {"fingertips": render_fingertip_images, "nails": render_nail_images}


@pytest.fixture(scope="module", params=RENDERERS, ids=str)
def rendered(request):
    return RENDERERS[request.param], list(RENDERERS[request.param](6, seed=4))


def test_an_image_depends_on_its_seed_and_number_alone(rendered) -> None:
    render, images = rendered
    again = list(render(3, seed=4))
    for one, other in zip(images[: len(again)], again, strict=True):
        assert one.name == other.name and np.array_equal(one.tips, other.tips)
        assert np.array_equal(one.is_visible, other.is_visible)
    assert not np.array_equal(images[0].tips, next(iter(render(1, seed=5))).tips)


def test_an_image_has_room_around_its_hands_and_what_is_visible_lies_in_it(rendered) -> None:
    _, images = rendered
    assert len(images) >= 5 and any(image.is_visible.any() for image in images)
    for image in images:
        region = image.region
        assert min(region.row, region.column) >= 0 and min(region.height, region.width) > 16
        seen = image.tips[image.is_visible]
        assert (seen >= -0.5).all() and (seen <= [region.width - 0.5, region.height - 0.5]).all()
        assert len(image.tips) == len(image.is_visible)


def test_a_visible_point_lies_on_a_hand_and_not_beside_it(rendered) -> None:
    _, images = rendered
    on_hand = [
        bool((image.image.depth[max(0, round(y) - 6) : round(y) + 7, max(0, round(x) - 6) : round(x) + 7] > 0).any())
        for image in images
        for x, y in image.tips[image.is_visible]
    ]
    assert len(on_hand) > 5 and np.mean(on_hand) > 0.95


def test_nails_are_rendered_near_enough_to_be_seen() -> None:
    assert NEAR_ENOUGH.farthest <= 0.6 and NEAR_ENOUGH.small_camera == 0.0


def test_people_and_walls_differ_and_are_the_same_for_the_same_chance() -> None:
    one, same, other = (random_texture(np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert one == same and one != other

"""Images to learn nails from: the rendered nails that can be told, and the hand roughly where it is expected."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.scene import Scene
from tracker.rendering.seen_nails import NailPlaces
from tracker.search.nail_views import MARGIN
from tracker.synthesis.nail_images import NEAR_ENOUGH, random_texture, render_nail_images
from tracker.synthesis.performance import render_moment
from tracker.synthesis.random_hands import RandomHands, arrange_random_hands

SEED = 4


@pytest.fixture(scope="module")
def pairs() -> list:
    """Each image beside what was arranged and drawn for it."""
    found = []
    for image in render_nail_images(2, SEED):
        performance = arrange_random_hands(NEAR_ENOUGH, np.random.default_rng([SEED, 1, int(image.name.split()[1])]))
        found.append((image, performance, render_moment(performance, 0)))
    return found


def test_what_is_marked_are_middles_of_nails_and_every_visible_one_is_among_them(pairs) -> None:
    for image, performance, moment in pairs:
        places = NailPlaces.of(Scene(tuple(one.model for one in performance.actors)))
        every = performance.camera.project(places.points(moment.vertices))
        first = np.array([image.region.column, image.region.row], dtype=np.float64)
        marked = image.tips + first
        nearest = np.linalg.norm(marked[:, None] - every, axis=2).argmin(axis=1)
        np.testing.assert_allclose(marked, every[nearest], atol=1e-6)
        assert np.all(np.diff(nearest) > 0), "in the order of the nails"
        is_visible = places.find_visible(moment.vertices, performance.camera, moment.depth, np.zeros(2))
        np.testing.assert_array_equal(np.flatnonzero(is_visible), nearest[image.is_visible])


def test_the_part_holds_all_of_the_hands_with_room_around_them(pairs) -> None:
    for image, performance, moment in pairs:
        is_hand = (moment.face >= 0) & (performance.face_actors[moment.face] < len(performance.hands))
        rows, columns = np.nonzero(is_hand)
        room = MARGIN * performance.camera.K[0, 0] / np.median(moment.depth[is_hand])
        region, camera = image.region, performance.camera
        assert 0 <= region.row <= max(0.0, rows.min() - room) and 0 <= region.column <= max(0.0, columns.min() - room)
        assert region.row + region.height >= min(camera.height, rows.max() + room)
        assert region.column + region.width >= min(camera.width, columns.max() + room)


def test_all_of_the_hands_is_looked_at_though_they_are_expected_a_little_beside(pairs) -> None:
    for image, performance, moment in pairs:
        region = image.region
        inside = (slice(region.row, region.row + region.height), slice(region.column, region.column + region.width))
        is_hand = (moment.face[inside] >= 0) & (performance.face_actors[moment.face[inside]] < len(performance.hands))
        assert image.image.mask[is_hand].mean() > 0.98
        assert not image.image.mask.all(), "and not everything beside them"


def test_hands_so_far_away_that_no_nail_shows_give_no_image() -> None:
    assert list(render_nail_images(2, SEED, RandomHands(nearest=9.0, farthest=9.5, small_camera=1.0))) == []


@pytest.mark.parametrize("seed", range(20))
def test_skin_and_nails_of_random_people_are_colours_that_skin_and_nails_have(seed: int) -> None:
    texture = random_texture(np.random.default_rng(seed))
    assert texture.nails is not None
    for color in (texture.nails.plate, texture.nails.edge):
        assert all(0.15 <= value <= 0.95 for value in color)
    assert all(edge >= plate - 1e-12 for plate, edge in zip(texture.nails.plate, texture.nails.edge, strict=True))
    assert 0.5 <= texture.nails.fold <= 0.95 and 0.001 <= texture.grain <= 0.004

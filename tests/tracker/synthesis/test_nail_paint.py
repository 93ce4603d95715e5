"""Nails in rendered colour images: where they are, and nothing else changes."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.rendering.seen_nails import NailPlaces
from tracker.synthesis.motion import perform
from tracker.synthesis.nail_images import render_nail_images
from tracker.synthesis.nail_paint import NailPaint
from tracker.synthesis.performance import Performance, render_moment
from tracker.synthesis.texture import Texture


@pytest.fixture(scope="module")
def performance() -> Performance:
    """A fist: its nails are turned to the camera."""
    return perform({"right": default_hand("right")}, "open-close", 46, 1, (640, 480))


def test_nails_are_painted_where_they_are_and_nothing_else_changes(performance: Performance) -> None:
    moment = render_moment(performance, 32)
    paint = NailPaint(plate=(0.1, 0.1, 0.9), edge=(0.1, 0.1, 0.9))
    bare, painted = (Texture(nails=nails).shade(performance, moment, None).astype(int) for nails in (None, paint))
    changed = np.abs(bare - painted).max(axis=2) > 8
    places = NailPlaces.of(Scene(tuple(actor.model for actor in performance.actors)))
    is_visible = places.find_visible(moment.vertices, performance.camera, moment.depth, np.zeros(2))
    assert np.count_nonzero(is_visible) >= 3
    middles = performance.camera.project(places.points(moment.vertices))
    for column, row in np.rint(middles[is_visible]).astype(int):
        assert painted[row, column, 2] > 1.3 * painted[row, column, 0]
    rows, columns = np.nonzero(changed)
    nearest = np.linalg.norm(np.column_stack([columns, rows])[:, None] - middles[None], axis=2).min(axis=1)
    assert nearest.max() < 0.011 * performance.camera.K[0, 0] / moment.depth[moment.face >= 0].min() + 3
    assert 100 < np.count_nonzero(changed) < 0.1 * np.count_nonzero(moment.face >= 0)


def test_images_to_learn_from_show_a_nail_at_each_place_that_is_called_visible() -> None:
    images = list(render_nail_images(6, 2))
    again = list(render_nail_images(6, 2))
    assert sum(np.count_nonzero(item.is_visible) for item in images) >= 4
    for item, other in zip(images, again, strict=True):
        np.testing.assert_array_equal(item.image.color, other.image.color)
        height, width = item.image.depth.shape
        seen = item.tips[item.is_visible]
        assert np.all((seen > -0.5) & (seen < [width - 0.5, height - 0.5]))
        assert item.image.mask.any() and np.all(item.image.depth[item.image.mask] > 0.1)
        assert len(item.tips) == len(item.is_visible) <= 10

"""Textured images: the pattern sticks to the surface, and the wall stands still."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tracker.model.default_hand import default_hand
from tracker.synthesis.motion import perform
from tracker.synthesis.performance import Performance, render_moment
from tracker.synthesis.texture import Texture, _find_shares


@pytest.fixture(scope="module")
def performance() -> Performance:
    return perform({"right": default_hand("right")}, "wave", 4, 2, (320, 240))


def test_shares_lead_back_to_the_pixel(performance):
    moment = render_moment(performance, 0)
    rows, columns = np.nonzero(moment.face >= 0)
    shares = _find_shares(performance, moment, rows, columns)
    assert shares.min() > -1e-6
    points = np.einsum("nc,nci->ni", shares, moment.vertices[performance.faces[moment.face[rows, columns]]])
    np.testing.assert_allclose(performance.camera.project(points), np.column_stack([columns, rows]), atol=1e-6)


def test_the_wall_stands_still_and_each_camera_has_its_own(performance):
    texture = Texture(seed=3)
    moments = [render_moment(performance, index) for index in (0, 3)]
    images = [texture.shade(performance, moment, None) for moment in moments]
    is_wall = np.all([moment.face < 0 for moment in moments], axis=0)
    far = cv2.erode(is_wall.astype(np.uint8), np.ones((9, 9))) > 0
    assert far.mean() > 0.3
    np.testing.assert_array_equal(images[0][far], images[1][far])
    other = performance.seen_by(performance.cameras[1])
    seen = texture.shade(other, render_moment(other, 0), None)
    assert np.abs(seen[far].astype(int) - images[0][far]).mean() > 3.0


def test_skin_is_spotted_and_the_same_seed_gives_the_same_image(performance):
    moment = render_moment(performance, 0)
    spotted, again = (Texture().shade(performance, moment, np.random.default_rng(1)) for _ in range(2))
    np.testing.assert_array_equal(spotted, again)
    plain = Texture(contrast=0.0).shade(performance, moment, np.random.default_rng(1))
    is_skin = moment.face >= 0
    ratio = spotted[is_skin].astype(float)[:, 0] / np.maximum(plain[is_skin].astype(float)[:, 0], 1.0)
    assert 0.02 < ratio.std() < 0.2
    assert np.any(
        replace(Texture(), seed=1).shade(performance, moment, None) != Texture().shade(performance, moment, None)
    )

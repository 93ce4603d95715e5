"""Edges of colour images, by direction."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tracker.capture.camera import Camera
from tracker.observation.image_edges import DIRECTIONS, find_image_edges, find_nearest_edge, sort_offsets

K = np.array([[300.0, 0.0, 80.0], [0.0, 300.0, 60.0], [0.0, 0.0, 1.0]])
CAMERA = Camera("cam0", 160, 120, K)


def bright_square() -> np.ndarray:
    image = np.full((120, 160, 3), 20, dtype=np.uint8)
    image[40:80, 60:100] = 220
    return image


def test_the_nearest_edge_is_one_of_the_direction_that_is_asked_for():
    found = find_image_edges(bright_square(), CAMERA, np.array([[50.0, 30.0], [110.0, 90.0]]), 10.0)
    left, top = (K[:2, 2] - found.K[:2, 2]).astype(int)

    def nearest(direction: int, row: int, column: int) -> tuple[float, float]:
        seen = (found.directions, found.places, sort_offsets(32))
        return find_nearest_edge(seen, row, column, direction, 30.0)[:2]

    row, column = 60 - top, 70 - left  # inside, nearer to the left side than to the right, 20 px from top and bottom
    assert nearest(0, row, column) == pytest.approx((row, 59.5 - left), abs=0.1)
    row = 50 - top
    assert nearest(DIRECTIONS // 2, row, column) == pytest.approx((39.5 - top, column), abs=0.1)


def test_an_edge_is_of_its_own_direction_and_of_both_neighbours():
    found = find_image_edges(bright_square(), CAMERA, np.array([[50.0, 30.0], [110.0, 90.0]]), 10.0)
    counted = np.unpackbits(found.directions[..., None], axis=2).sum(axis=2)
    assert set(np.unique(counted)) == {0, 3}
    left, top = (K[:2, 2] - found.K[:2, 2]).astype(int)
    side = found.directions[60 - top, 56 - left : 64 - left]
    assert set(side[side != 0].tolist()) == {0b100011}


@given(
    arrays(np.uint8, (13, 17), elements=st.sampled_from([0, 0, 0, 0b000111, 0b100011, 0b111000])),
    st.integers(0, 2**32 - 1),
    st.integers(0, DIRECTIONS - 1),
    st.floats(0.0, 30.0),
)
def test_no_edge_of_the_direction_is_nearer_than_the_one_found(directions, seed, direction, reach):
    rng = np.random.default_rng(seed)
    point = rng.uniform(-1.0, [14.0, 18.0])
    pixels = np.stack(np.meshgrid(np.arange(13.0), np.arange(17.0), indexing="ij"), axis=2)
    shifts = rng.uniform(-0.5, 0.5, (13, 17))
    places = (pixels + np.stack([shifts, np.zeros_like(shifts)], axis=2)).astype(np.float32)
    seen = (directions, places, sort_offsets(32))
    *found, apart = find_nearest_edge(seen, point[0], point[1], direction, reach)
    every = places[directions & (1 << direction) > 0].astype(np.float64)
    distances = np.linalg.norm(every - point, axis=1)
    if not np.any(distances <= reach):
        assert np.isinf([*found, apart]).all()
    else:
        assert apart == pytest.approx(distances.min(), abs=1e-9)
        assert np.linalg.norm(found - point) == pytest.approx(apart, abs=1e-9)


def test_a_plain_image_has_no_edges_and_what_is_out_of_sight_no_part():
    plain = np.full((120, 160, 3), 128, dtype=np.uint8)
    assert not find_image_edges(plain, CAMERA, np.array([[80.0, 60.0]]), 20.0).directions.any()
    assert find_image_edges(plain, CAMERA, np.array([[500.0, 60.0], [520.0, 70.0]]), 20.0) is None
    assert find_image_edges(plain, CAMERA, np.full((1, 2), np.nan), 20.0) is None

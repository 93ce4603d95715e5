"""Pixels around a pixel, nearest first, and the pixel of a vertex."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from tracker.terms.nearby_pixels import find_nearby_pixels, find_ring_pixel, find_vertex_pixel


def test_pixels_near_by_come_nearest_first_and_all_of_them():
    nearby = find_nearby_pixels(5)
    distances = np.hypot(*nearby.T)
    assert np.all(np.diff(distances) >= 0.0)
    inside = [(r, c) for r in range(-5, 6) for c in range(-5, 6) if r * r + c * c <= 25]
    assert sorted(map(tuple, nearby.tolist())) == sorted(inside)


def test_a_radius_of_nothing_is_the_pixel_itself_and_nobody_can_change_what_is_shared():
    assert find_nearby_pixels(0).tolist() == [[0, 0]]
    assert find_nearby_pixels(3) is find_nearby_pixels(3)
    with pytest.raises(ValueError, match="read-only"):
        find_nearby_pixels(3)[0] = 1
    with pytest.raises(AssertionError):
        find_nearby_pixels(-1)


@pytest.mark.parametrize("ring", [1, 2, 5])
def test_a_ring_is_all_pixels_at_its_distance_with_only_the_corners_met_twice(ring):
    met = Counter(find_ring_pixel(10, 20, ring, side, edge) for edge in range(4) for side in range(2 * ring + 1))
    square = {
        (r, c)
        for r in range(10 - ring, 11 + ring)
        for c in range(20 - ring, 21 + ring)
        if max(abs(r - 10), abs(c - 20)) == ring
    }
    assert set(met) == square
    assert {pixel for pixel, times in met.items() if times == 2} == {
        (10 + dr * ring, 20 + dc * ring) for dr in (-1, 1) for dc in (-1, 1)
    }


def test_ring_nothing_is_the_pixel_itself():
    assert find_ring_pixel(10, 20, 0, 0, 0) == (10, 20)


@pytest.mark.parametrize(
    ("column", "row", "inverse", "pixel"),
    [
        (3.4, 7.6, 2.0, (8, 3)),
        (-0.4, -0.4, 2.0, (0, 0)),
        (-0.6, 3.0, 2.0, (-1, -1)),
        (3.0, -0.6, 2.0, (-1, -1)),
        (11.4, 8.4, 2.0, (8, 11)),
        (11.6, 8.4, 2.0, (-1, -1)),
        (11.4, 8.6, 2.0, (-1, -1)),
        (3.4, 7.6, 0.0, (-1, -1)),
        (1e9, 3.0, 2.0, (-1, -1)),
    ],
)
def test_a_vertex_is_in_the_pixel_whose_centre_is_nearest_or_nowhere(column, row, inverse, pixel):
    projected = np.array([[0.0, 0.0, 0.0], [column, row, inverse]])
    assert find_vertex_pixel(projected, 1, 9, 12) == pixel

"""Channels equal their plain definition."""

import numpy as np
from scipy import ndimage

from tracker.detection.channels import BINS, CELL, CHANNELS, GAIN, STEEP, compute_channels


def plain_channels(image: np.ndarray) -> np.ndarray:
    """The same with whole-image operations."""
    steps = image.astype(np.float64)
    gx, gy = np.zeros_like(steps), np.zeros_like(steps)
    gx[1:-1, 1:-1] = np.clip(steps[1:-1, 2:] - steps[1:-1, :-2], -STEEP, STEEP)
    gy[1:-1, 1:-1] = np.clip(steps[2:, 1:-1] - steps[:-2, 1:-1], -STEEP, STEEP)
    place = (np.arctan2(gy, gx) % np.pi) * BINS / np.pi
    magnitude = np.hypot(gx, gy)
    oriented = np.zeros((*image.shape, BINS))
    for b in range(BINS):
        away = np.abs(place - b)
        oriented[..., b] = magnitude * np.maximum(0.0, 1.0 - np.minimum(away, BINS - away))
    cells = ndimage.convolve(oriented, np.ones((CELL, CELL, 1)), mode="constant")
    low = ndimage.minimum_filter(image, CELL, mode="nearest")
    high = ndimage.maximum_filter(image, CELL, mode="nearest")
    return np.concatenate([low[..., None], high[..., None], np.minimum(255, np.floor(GAIN * cells))], axis=2)


def test_channels_equal_plain_numpy(rng):
    smooth = ndimage.gaussian_filter(rng.uniform(0, 255, (41, 37)), 2.0)
    steps = np.where(rng.random((41, 37)) < 0.02, 255, 4 * (smooth - smooth.mean()) + 128)
    for image in (np.clip(steps, 0, 255).astype(np.uint8), rng.integers(0, 256, (23, 30), dtype=np.uint8)):
        channels, plain = compute_channels(image), plain_channels(image)
        assert channels.shape == (*image.shape, CHANNELS)
        np.testing.assert_array_equal(channels[..., :2], plain[..., :2])
        assert np.abs(channels[..., 2:].astype(int) - plain[..., 2:]).max() <= 1  # floor of nearly equal sums


def test_a_straight_edge_fills_the_bin_of_its_direction_alone():
    image = np.zeros((20, 20), dtype=np.uint8)
    image[:, 10:] = 200
    at_edge = compute_channels(image)[10, 10, 2:]
    assert at_edge[0] == int(GAIN * CELL * 2 * STEEP)
    assert not at_edge[1:].any()


def test_an_image_smaller_than_a_cell_is_no_trouble():
    assert compute_channels(np.full((1, 2), 7, dtype=np.uint8)).shape == (1, 2, CHANNELS)

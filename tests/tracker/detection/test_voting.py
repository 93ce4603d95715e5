"""Patches go down the trees and their leaves vote, as NumPy written plainly says."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.detection.channels import CHANNELS
from tracker.detection.default_detector import default_detector
from tracker.detection.levels import PAD, PATCH, Level
from tracker.detection.voting import MIN_PROBABILITY, find_leaves, vote_into

FOREST = default_detector()
CELL, WEIGHT = 2.0, 0.7


def make_level(rng: np.random.Generator, count: int = 40, size: tuple[int, int] = (30, 40)) -> Level:
    """Noise: patches anywhere, up to the border."""
    height, width = size
    channels = rng.integers(0, 256, (height + 2 * PAD, width + 2 * PAD, CHANNELS), dtype=np.uint8)
    centers = np.c_[rng.integers(0, height, count), rng.integers(0, width, count)].astype(np.int32)
    depths = rng.uniform(0.4, 0.8, count).astype(np.float32)
    return Level(0.5, 2.5, channels, centers, depths, np.zeros(size, np.float32))


def walk(patch: np.ndarray, tree: int) -> int:
    """The leaf, counted over the forest, that a patch (PATCH, PATCH, CHANNELS) reaches."""
    place = 0
    while True:
        channel, first, second, threshold, child = (int(v) for v in FOREST.nodes[FOREST.node_starts[tree] + place])
        if channel < 0:
            return int(FOREST.leaf_starts[tree]) + child
        one, other = (int(patch[at // PATCH, at % PATCH, channel]) for at in (first, second))
        place = child + (one - other > threshold)


def test_each_patch_reaches_the_leaf_that_its_tests_lead_to(rng: np.random.Generator) -> None:
    level = make_level(rng)
    expected = [
        [walk(level.channels[row : row + PATCH, column : column + PATCH], tree) for tree in range(FOREST.num_trees)]
        for row, column in level.centers
    ]
    np.testing.assert_array_equal(find_leaves(FOREST, level), expected)


def test_votes_fall_where_the_leaves_say_shared_by_the_four_cells_around(rng: np.random.Generator) -> None:
    level = make_level(rng)
    density, depth_sum = np.zeros((40, 55), np.float32), np.zeros((40, 55), np.float32)
    vote_into(density, depth_sum, FOREST, level, CELL, WEIGHT)
    expected, depths = np.zeros_like(density, dtype=float), np.zeros_like(density, dtype=float)
    for (row, column), depth, leaves in zip(level.centers, level.depths, find_leaves(FOREST, level), strict=True):
        centre = (np.array([column, row]) + 0.5) * level.spacing - 0.5
        for leaf in leaves[FOREST.probability[leaves] > MIN_PROBABILITY]:
            for x, y, z, share in FOREST.votes[leaf]:
                at = (centre + level.spacing * level.depth / depth * np.array([x, y])) / CELL
                low = np.floor(at).astype(int)
                if (low < 0).any() or low[0] + 1 >= 55 or low[1] + 1 >= 40:
                    continue
                part = at - low
                for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
                    vote = WEIGHT * FOREST.probability[leaf] * share
                    vote *= (part[0] if dx else 1 - part[0]) * (part[1] if dy else 1 - part[1])
                    expected[low[1] + dy, low[0] + dx] += vote
                    depths[low[1] + dy, low[0] + dx] += vote * (depth + FOREST.pixel_size * z)
    assert expected.max() > 0.0
    np.testing.assert_allclose(density, expected, atol=1e-4)
    np.testing.assert_allclose(depth_sum, depths, atol=1e-4)


@pytest.mark.parametrize("count", [0, 1])
def test_votes_that_fall_outside_are_no_votes(count: int, rng: np.random.Generator) -> None:
    level = make_level(rng, count)
    density, depth_sum = np.zeros((1, 1), np.float32), np.zeros((1, 1), np.float32)
    vote_into(density, depth_sum, FOREST, level, CELL, WEIGHT)
    assert not density.any() and not depth_sum.any()

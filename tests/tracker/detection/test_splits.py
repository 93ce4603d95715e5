"""The best test of a node is the best of all that plain NumPy finds, by class and by offset."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.detection.channels import CHANNELS
from tracker.detection.levels import PATCH
from tracker.detection.splits import THRESHOLDS, find_best_split, goes_right

WIDTH, COUNT, PAIRS = 40, 60, 12


class Node:
    """Patches of noise, some of them fingertips whose first channel tells them apart."""

    def __init__(self, rng: np.random.Generator, told: float = 0.0) -> None:
        self.image = rng.integers(0, 256, (WIDTH, WIDTH, CHANNELS), dtype=np.uint8)
        places = rng.integers(0, WIDTH - PATCH, (COUNT, 2))
        self.corners = (places[:, 0] * WIDTH + places[:, 1]) * CHANNELS
        self.is_fingertip = rng.random(COUNT) < 0.5
        self.offsets = rng.normal(size=(COUNT, 2)).astype(np.float32)
        self.pairs = np.stack([rng.integers(0, most, PAIRS) for most in (CHANNELS, PATCH**2, PATCH**2)], axis=1)
        self.cuts = rng.random((PAIRS, THRESHOLDS))
        self.members = np.arange(COUNT)
        if told:
            values = self.values(self.pairs[0])
            self.is_fingertip = values > np.quantile(values, told)

    @property
    def patches(self) -> tuple[np.ndarray, ...]:
        widths = np.full(COUNT, WIDTH)
        return self.image.reshape(-1), self.corners, widths, self.is_fingertip, self.offsets

    def values(self, pair: np.ndarray) -> np.ndarray:
        """(COUNT,) difference of the two pixels of a pair in each patch."""
        flat = self.image.reshape(-1).astype(int)
        one, other = (self.corners + ((p // PATCH) * WIDTH + p % PATCH) * CHANNELS + pair[0] for p in pair[1:])
        return flat[one] - flat[other]

    def tests(self) -> list[tuple[int, int, int, int]]:
        found = []
        for pair, cuts in zip(self.pairs, self.cuts, strict=True):
            values = self.values(pair)
            limits = values.min() + (cuts * (values.max() - values.min())).astype(int)
            found += [(*(int(v) for v in pair), int(limit)) for limit in limits]
        return found

    def find(self, by_offset: bool, min_leaf: float = 2.0, weight: float = 1.0) -> tuple[int, ...] | None:
        best = np.zeros(4, dtype=np.int16)
        found = find_best_split(self.patches, self.members, self.pairs, self.cuts, by_offset, weight, min_leaf, best)
        return tuple(int(v) for v in best) if found else None


def entropy(is_fingertip: np.ndarray, weight: float) -> float:
    parts = np.array([is_fingertip.sum(), weight * (~is_fingertip).sum()], dtype=float)
    shares = parts[parts > 0] / parts.sum()
    return -float(parts.sum() * (shares * np.log(shares)).sum())


def scatter(offsets: np.ndarray) -> float:
    return float(np.sum((offsets - offsets.mean(axis=0)) ** 2)) if len(offsets) else 0.0


def cost(node: Node, test: tuple[int, ...], by_offset: bool, weight: float) -> float:
    is_right = node.values(np.array(test[:3])) > test[3]
    total = 0.0
    for side in (is_right, ~is_right):
        tips = node.is_fingertip[side]
        total += scatter(node.offsets[side][tips].astype(float)) if by_offset else entropy(tips, weight)
    return total


@pytest.mark.parametrize("by_offset", [False, True], ids=["by class", "by offset"])
@pytest.mark.parametrize("weight", [1.0, 0.3])
def test_no_other_test_that_was_tried_separates_better(
    by_offset: bool, weight: float, rng: np.random.Generator
) -> None:
    node = Node(rng)
    found = node.find(by_offset, weight=weight)
    assert found is not None and found in node.tests()
    sides = [np.count_nonzero(node.values(np.array(test[:3])) > test[3]) for test in node.tests()]
    allowed = [test for test, right in zip(node.tests(), sides, strict=True) if 2 <= right <= COUNT - 2]
    costs = [cost(node, test, by_offset, weight) for test in allowed]
    assert cost(node, found, by_offset, weight) == pytest.approx(min(costs), rel=1e-6)


def test_a_pair_that_tells_the_classes_apart_is_found(rng: np.random.Generator) -> None:
    node = Node(rng, told=0.5)
    found = node.find(by_offset=False)
    assert found is not None and found[:3] == tuple(node.pairs[0])


def test_without_a_test_that_leaves_enough_on_both_sides_there_is_none(rng: np.random.Generator) -> None:
    node = Node(rng)
    assert node.find(by_offset=False, min_leaf=COUNT) is None
    node.image[:] = 7
    assert node.find(by_offset=False) is None, "all differences are the same"


def test_patches_go_right_where_the_difference_is_above_the_threshold(rng: np.random.Generator) -> None:
    node = Node(rng)
    test = np.array([*node.pairs[3], 5], dtype=np.int16)
    result = np.zeros(COUNT, dtype=np.bool_)
    goes_right(node.patches[0], node.corners, node.patches[2], node.members, test, result)
    np.testing.assert_array_equal(result, node.values(node.pairs[3]) > 5)

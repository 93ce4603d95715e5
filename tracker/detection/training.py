"""Grow a Hough forest from patches."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.detection.channels import CHANNELS
from tracker.detection.forest import MODES, Forest
from tracker.detection.levels import PATCH
from tracker.detection.modes import find_modes
from tracker.detection.sampling import Patches, PatchOptions
from tracker.detection.splits import THRESHOLDS, find_best_split, goes_right
from tracker.errors import TrackerError

MAX_NODES = 32_000
"""Of a tree; its numbers must fit into int16."""


@dataclass(frozen=True)
class ForestOptions:
    """How trees are grown, [T16] §3.2.5.

    Attributes:
        trees: How many.
        depth: Deepest leaf.
        min_leaf: Fewest patches in a leaf.
        tests: Binary tests that are tried at a node.
        patches: Of each sort, that a tree learns from; each tree draws its own.
        tried_on: Tests are tried on at most so many patches of a node; all of them are then divided.
        box_size: Side of a detection's box, m.
        seed: Of chance; the same seed grows the same forest, on any number of threads.
        threads: Trees that are grown at a time.
    """

    trees: int = 10
    depth: int = 25
    min_leaf: int = 20
    tests: int = 20_000
    patches: int = 100_000
    tried_on: int = 8_000
    box_size: float = 0.032
    seed: int = 0
    threads: int = 1


def train_forest(
    patches: Patches,
    about: PatchOptions,
    options: ForestOptions,
    progress: Callable[[float], None] = lambda share: None,
) -> Forest:
    """A forest whose confidences are not calibrated yet.

    Args:
        patches: To learn from.
        about: How they were taken.
        options: How to grow trees.
        progress: Told the share that is done, 0 to 1.

    Raises:
        TrackerError: Too few patches of one sort.
    """
    positive, negative = np.flatnonzero(patches.is_fingertip), np.flatnonzero(~patches.is_fingertip)
    if min(len(positive), len(negative)) < 2 * options.min_leaf:
        raise TrackerError(
            f"Found {len(positive)} patches with and {len(negative)} without a fingertip; needed at least "
            f"{2 * options.min_leaf} of each. Give recordings with more visible, annotated fingertips."
        )

    def grow(number: int) -> _Tree:
        rng = np.random.default_rng([options.seed, number])
        members = np.concatenate([_draw(sort, options.patches, rng) for sort in (positive, negative)])
        return _grow_tree(patches, members, options, rng)

    trees: list[_Tree] = []
    with ThreadPoolExecutor(max(1, options.threads)) as pool:
        for tree in pool.map(grow, range(options.trees)):
            trees.append(tree)
            progress(len(trees) / options.trees)
    return Forest(
        kind=about.kind,
        pixel_size=about.pixel_size,
        box_size=options.box_size,
        confidence_scale=1.0,
        nodes=np.concatenate([tree.nodes for tree in trees]),
        node_starts=np.cumsum([0, *(len(tree.nodes) for tree in trees)]).astype(np.int32),
        leaf_starts=np.cumsum([0, *(len(tree.probability) for tree in trees)]).astype(np.int32),
        probability=np.concatenate([tree.probability for tree in trees]),
        votes=np.concatenate([tree.votes for tree in trees]),
    )


@dataclass(frozen=True)
class _Tree:
    nodes: npt.NDArray[np.int16]
    probability: npt.NDArray[np.float32]
    votes: npt.NDArray[np.float32]


def _draw(places: npt.NDArray[np.int64], count: int, rng: np.random.Generator) -> npt.NDArray[np.int64]:
    return places if len(places) <= count else np.sort(rng.choice(places, count, replace=False))


def _grow_tree(
    patches: Patches, members: npt.NDArray[np.int64], options: ForestOptions, rng: np.random.Generator
) -> _Tree:
    """One tree, nodes in the order of their depth; tests by class and by offset take turns with the depth."""
    share = np.count_nonzero(patches.is_fingertip[members]) / len(members)
    negative_weight = share / (1.0 - share)
    nodes: list[tuple[int, ...]] = [()]
    probability: list[float] = []
    votes: list[npt.NDArray[np.float32]] = []
    waiting = deque([(0, 0, members)])
    while waiting:
        node, depth, members = waiting.popleft()
        positives = int(np.count_nonzero(patches.is_fingertip[members]))
        test = None
        if depth < options.depth and len(members) >= 2 * options.min_leaf and positives > 0 and len(nodes) < MAX_NODES:
            # Nothing is left to tell apart by class where nearly all are fingertips.
            mostly_tips = len(members) - positives < 0.05 * len(members)
            test = _find_test(patches, members, options, depth % 2 == 1 or mostly_tips, negative_weight, rng)
        if test is not None:
            passes = np.empty(len(members), dtype=np.bool_)
            goes_right(patches.channels, patches.corners, patches.widths, members, test, passes)
            sides = members[~passes], members[passes]
            if min(len(side) for side in sides) >= options.min_leaf:
                nodes[node] = (*(int(value) for value in test), len(nodes))
                for step, side in enumerate(sides):
                    waiting.append((len(nodes) + step, depth + 1, side))
                nodes += [(), ()]
                continue
        nodes[node] = (-1, 0, 0, 0, len(probability))
        weighted = negative_weight * (len(members) - positives)
        probability.append(positives / (positives + weighted))
        votes.append(find_modes(patches.offsets[members[patches.is_fingertip[members]]], MODES))
    return _Tree(
        np.array(nodes, dtype=np.int16), np.array(probability, dtype=np.float32), np.array(votes, dtype=np.float32)
    )


def _find_test(
    patches: Patches,
    members: npt.NDArray[np.int64],
    options: ForestOptions,
    by_offset: bool,
    negative_weight: float,
    rng: np.random.Generator,
) -> npt.NDArray[np.int16] | None:
    """The best of many random tests: channel, first, second, threshold; None if none divides the members."""
    tried = members if len(members) <= options.tried_on else rng.choice(members, options.tried_on, replace=False)
    count = max(1, options.tests // THRESHOLDS)
    pairs = np.stack([rng.integers(0, limit, count) for limit in (CHANNELS, PATCH * PATCH, PATCH * PATCH)], axis=1)
    best = np.zeros(4, dtype=np.int16)
    found = find_best_split(
        (patches.channels, patches.corners, patches.widths, patches.is_fingertip, patches.offsets),
        np.sort(tried),
        pairs,
        rng.random((count, THRESHOLDS)),
        by_offset,
        negative_weight,
        max(1.0, options.min_leaf * len(tried) / len(members)),
        best,
    )
    return best if found else None

"""Patches go down the trees and their leaves vote for fingertips."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.detection.channels import CHANNELS
from tracker.detection.forest import Forest
from tracker.detection.levels import PATCH, Level

MIN_PROBABILITY = 0.5
"""Leaves with a smaller share of fingertip patches don't vote."""


def find_leaves(forest: Forest, level: Level) -> npt.NDArray[np.int32]:
    """(N, T) the leaf that each patch of a level reaches in each tree, counted over the forest."""
    leaves = np.empty((len(level.centers), forest.num_trees), dtype=np.int32)
    _find_leaves_into(
        leaves,
        level.channels.reshape(-1),
        level.channels.shape[1],
        level.centers,
        forest.nodes,
        forest.node_starts,
        forest.leaf_starts,
    )
    return leaves


def vote_into(
    density: npt.NDArray[np.float32],
    depth_sum: npt.NDArray[np.float32],
    forest: Forest,
    level: Level,
    cell: float,
    weight: float,
) -> None:
    """Add a level's votes.

    Args:
        density: (H, W) sum of votes; `cell` px of the image apart.
        depth_sum: (H, W) sum of votes times the depth they vote for, m.
        forest: Whose leaves vote.
        level: With patches.
        cell: px of the image.
        weight: Of a vote.
    """
    _vote_into(
        density,
        depth_sum,
        (find_leaves(forest, level), level.centers, level.depths),
        (forest.probability, forest.votes, forest.pixel_size),
        level.spacing,
        level.spacing * level.depth,
        cell,
        weight,
    )


@njit(cache=True, nogil=True)
def _find_leaves_into(leaves, channels, width, centers, nodes, node_starts, leaf_starts):
    for tree in range(leaves.shape[1]):
        first_node, first_leaf = node_starts[tree], leaf_starts[tree]
        for n in range(len(centers)):
            corner = (centers[n, 0] * width + centers[n, 1]) * CHANNELS
            node = nodes[first_node]
            while node[0] >= 0:
                a, b = node[1], node[2]
                one = channels[corner + ((a // PATCH) * width + a % PATCH) * CHANNELS + node[0]]
                other = channels[corner + ((b // PATCH) * width + b % PATCH) * CHANNELS + node[0]]
                child = node[4]
                if np.int32(one) - np.int32(other) > node[3]:
                    child += 1
                node = nodes[first_node + child]
            leaves[n, tree] = first_leaf + node[4]


@njit(cache=True, nogil=True)
def _vote_into(density, depth_sum, patches, forest, spacing, reach, cell, weight):
    leaves, centers, depths = patches
    probability, votes, pixel_size = forest
    height, width = density.shape
    for n in range(len(leaves)):
        row, column = (centers[n, 0] + 0.5) * spacing - 0.5, (centers[n, 1] + 0.5) * spacing - 0.5
        depth = depths[n]
        scale = reach / depth  # px of the image per px of a patch, at the patch's own depth
        for tree in range(leaves.shape[1]):
            leaf = leaves[n, tree]
            share = probability[leaf]
            if share <= MIN_PROBABILITY:
                continue
            for mode in range(votes.shape[1]):
                strength = weight * share * votes[leaf, mode, 3]
                if strength == 0.0:
                    break
                x = (column + scale * votes[leaf, mode, 0]) / cell
                y = (row + scale * votes[leaf, mode, 1]) / cell
                there = depth + pixel_size * votes[leaf, mode, 2]
                left, top = int(np.floor(x)), int(np.floor(y))
                if left < 0 or top < 0 or left + 1 >= width or top + 1 >= height:
                    continue
                fx, fy = x - left, y - top
                for i in range(2):
                    for j in range(2):
                        part = strength * (fy if i == 1 else 1.0 - fy) * (fx if j == 1 else 1.0 - fx)
                        density[top + i, left + j] += part
                        depth_sum[top + i, left + j] += part * there

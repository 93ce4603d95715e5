"""A forest learns what there is to learn, and always the same."""

from dataclasses import fields, replace

import numpy as np
import pytest

from tests.tracker.detection.toys import FOCAL, PATCHES, SMALL, disc_image, disc_patches
from tracker.detection.detect import DetectOptions, find_in_image
from tracker.detection.levels import PATCH, build_levels
from tracker.detection.training import train_forest
from tracker.detection.voting import find_leaves
from tracker.errors import TrackerError


@pytest.fixture(scope="module")
def patches():
    return disc_patches()


@pytest.fixture(scope="module")
def forest(patches):
    return train_forest(patches, PATCHES, SMALL)


def test_every_disc_of_new_images_is_found_within_two_pixels_and_nothing_else(forest):
    rng = np.random.default_rng(77)
    for _ in range(5):
        image, centers = disc_image(rng)
        peaks = find_in_image(forest, image, DetectOptions(min_confidence=0.0))
        best = peaks.centers[: len(centers)]
        distances = np.linalg.norm(best[:, None] - centers[None], axis=2)
        assert sorted(distances.argmin(axis=1)) == list(range(len(centers)))
        assert distances.min(axis=1).max() < 2.0
        assert len(peaks) == len(centers) or peaks.confidences[len(centers)] < 0.3 * peaks.confidences[0]
        np.testing.assert_allclose(peaks.depths[: len(centers)], 0.48, atol=0.004)


def test_the_same_disc_twice_as_far_is_found_with_the_same_confidence(forest, rng):
    image, _ = disc_image(rng)
    near = find_in_image(forest, image, DetectOptions(min_confidence=0.0))
    # Twice the distance and twice the focal length: the same picture, bumps and all, of things twice as far away.
    far = find_in_image(
        forest,
        replace(image, depth=(image.depth + np.float32(0.5)), focal=FOCAL * 2.0),
        DetectOptions(min_confidence=0.0),
    )
    distances = np.linalg.norm(far.centers[:3, None] - near.centers[None, :3], axis=2)
    assert distances.min(axis=1).max() < 1.0
    nearest = distances.argmin(axis=1)
    np.testing.assert_allclose(far.confidences[:3], near.confidences[nearest], rtol=0.35)


def test_boxes_have_their_size_in_metres(forest, rng):
    peaks = find_in_image(forest, disc_image(rng)[0], DetectOptions(min_confidence=0.0))
    sides = (peaks.boxes[:, 2:] - peaks.boxes[:, :2]) * peaks.depths[:, None] / FOCAL
    np.testing.assert_allclose(sides, SMALL.box_size, rtol=1e-9)


def test_training_does_not_depend_on_the_number_of_threads(patches, forest):
    other = train_forest(patches, PATCHES, replace(SMALL, threads=2))
    for field in fields(forest):
        np.testing.assert_array_equal(getattr(forest, field.name), getattr(other, field.name))


def test_leaves_are_as_large_and_trees_as_deep_as_allowed(patches, forest):
    members = np.bincount(_walk(forest, patches, 0), minlength=forest.leaf_starts[1])
    # Each tree saw all patches, so every leaf holds what it learnt from.
    assert members.min() >= SMALL.min_leaf
    assert _depth(forest, 0) <= SMALL.depth
    shallow = train_forest(patches, PATCHES, replace(SMALL, trees=1, depth=3))
    assert _depth(shallow, 0) <= 3
    assert len(shallow.nodes) <= 15


def test_probabilities_and_offsets_of_leaves_are_those_of_their_patches(patches, forest):
    leaves = _walk(forest, patches, 0)
    positives, negatives = patches.is_fingertip.sum(), (~patches.is_fingertip).sum()
    for leaf in np.unique(leaves):
        own = leaves == leaf
        hits = patches.is_fingertip[own].sum()
        weighted = (own.sum() - hits) * positives / negatives
        assert forest.probability[leaf] == pytest.approx(hits / (hits + weighted), rel=1e-6)
        if hits:
            votes = forest.votes[leaf].astype(float)
            mean = patches.offsets[own & patches.is_fingertip].mean(axis=0)
            np.testing.assert_allclose((votes[:, :3] * votes[:, 3:]).sum(axis=0), mean, atol=1e-3)


def test_patches_walk_the_same_way_in_training_and_detection(forest, rng):
    image, _ = disc_image(rng)
    level = build_levels(image, "depth", forest.pixel_size)[0]
    found = find_leaves(forest, level)
    for n in range(0, len(level.centers), 97):
        row, column = level.centers[n]
        patch = level.channels[row : row + PATCH, column : column + PATCH].reshape(PATCH * PATCH, -1).astype(int)
        for tree in range(forest.num_trees):
            nodes = forest.nodes[forest.node_starts[tree] : forest.node_starts[tree + 1]]
            place = 0
            while nodes[place, 0] >= 0:
                channel, first, second, threshold, child = nodes[place]
                place = child + int(patch[first, channel] - patch[second, channel] > threshold)
            assert found[n, tree] == forest.leaf_starts[tree] + nodes[place, 4]


def test_too_few_patches_are_refused_with_their_number(patches):
    few = replace(
        patches,
        corners=patches.corners[:30],
        widths=patches.widths[:30],
        is_fingertip=patches.is_fingertip[:30],
        offsets=patches.offsets[:30],
    )
    with pytest.raises(TrackerError, match="needed at least 20 of each"):
        train_forest(few, PATCHES, SMALL)


def _walk(forest, patches, tree) -> np.ndarray:
    """(N,) leaf of each patch, plainly."""
    nodes = forest.nodes[forest.node_starts[tree] : forest.node_starts[tree + 1]].astype(int)
    leaves = np.empty(len(patches), dtype=int)
    for n in range(len(patches)):
        place = 0
        while nodes[place, 0] >= 0:
            channel, first, second, threshold, child = nodes[place]
            values = [
                int(patches.channels[patches.corners[n] + (p // PATCH * patches.widths[n] + p % PATCH) * 11 + channel])
                for p in (first, second)
            ]
            place = child + int(values[0] - values[1] > threshold)
        leaves[n] = nodes[place, 4]
    return leaves


def _depth(forest, tree) -> int:
    nodes = forest.nodes[forest.node_starts[tree] : forest.node_starts[tree + 1]].astype(int)
    depths = np.zeros(len(nodes), dtype=int)
    for place, node in enumerate(nodes):
        if node[0] >= 0:
            depths[node[4] : node[4] + 2] = depths[place] + 1
    return int(depths.max())

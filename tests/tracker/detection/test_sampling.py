"""Patches are taken where they belong, and offsets lead to the fingertip."""

import numpy as np

from tests.tracker.detection.toys import FOCAL, PATCHES, disc_image
from tracker.detection.channels import CHANNELS
from tracker.detection.levels import build_levels
from tracker.detection.sampling import join_patches, sample_patches

ALL = np.ones(3, dtype=bool)


def centers_of(patches, image):
    """(N, 2) column and row of the patches' centres, px of the image; one level only."""
    (level,) = build_levels(image, "depth", PATCHES.pixel_size)
    places = patches.corners // CHANNELS
    rows, columns = places // patches.widths, places % patches.widths
    return (np.stack([columns, rows], axis=1) + 0.5) * level.spacing - 0.5, level


def test_offsets_lead_from_each_patch_to_a_fingertip(rng):
    image, tips = disc_image(rng)
    patches = sample_patches(image, tips, ALL, PATCHES, rng)
    centers, level = centers_of(patches, image)
    reached = centers[patches.is_fingertip] + patches.offsets[patches.is_fingertip, :2] * level.spacing
    distances = np.linalg.norm(reached[:, None] - tips[None], axis=2).min(axis=1)
    assert distances.max() < 1.0
    assert not patches.offsets[~patches.is_fingertip].any()


def test_depth_offsets_lead_to_the_fingertips_surface(rng):
    image, tips = disc_image(rng)
    patches = sample_patches(image, tips, ALL, PATCHES, rng)
    own = patches.is_fingertip
    behind = patches.offsets[own, 2] * PATCHES.pixel_size
    assert set(np.round(behind / 0.02).astype(int)) == {-1, 0}  # from the plane 2 cm nearer, from the disc not


def test_positives_are_near_negatives_far_and_neither_too_many(rng):
    image, tips = disc_image(rng)
    patches = sample_patches(image, tips, ALL, PATCHES, rng)
    centers, _ = centers_of(patches, image)
    distances = np.linalg.norm(centers[:, None] - tips[None], axis=2).min(axis=1) * 0.49 / FOCAL
    assert distances[patches.is_fingertip].max() < PATCHES.positive_reach * 1.05
    assert distances[~patches.is_fingertip].min() > PATCHES.negative_reach * 0.95
    assert patches.is_fingertip.sum() == (~patches.is_fingertip).sum() == PATCHES.per_image


def test_around_occluded_fingertips_nothing_is_learnt(rng):
    image, tips = disc_image(rng)
    patches = sample_patches(image, tips, np.zeros(3, dtype=bool), PATCHES, rng)
    assert not patches.is_fingertip.any()
    centers, _ = centers_of(patches, image)
    distances = np.linalg.norm(centers[:, None] - tips[None], axis=2).min(axis=1) * 0.49 / FOCAL
    assert distances.min() > PATCHES.hidden_reach * 0.95


def test_a_fingertip_beside_the_image_or_without_depth_is_no_trouble(rng):
    image, _ = disc_image(rng)
    odd = np.array([[-500.0, 20.0], [1e9, -1e9], [np.nan, np.nan]])
    patches = sample_patches(image, odd, ALL, PATCHES, rng)
    assert not patches.is_fingertip.any()
    assert len(sample_patches(image, np.zeros((0, 2)), np.zeros(0, dtype=bool), PATCHES, rng)) > 0


def test_collections_join_without_losing_their_channels(rng):
    parts = []
    for _ in range(3):
        image, tips = disc_image(rng)
        parts.append(sample_patches(image, tips, ALL, PATCHES, rng))
    joined = join_patches(parts)
    assert len(joined) == sum(len(part) for part in parts)
    last = parts[2]
    np.testing.assert_array_equal(
        joined.channels[joined.corners[-1] : joined.corners[-1] + 300],
        last.channels[last.corners[-1] : last.corners[-1] + 300],
    )

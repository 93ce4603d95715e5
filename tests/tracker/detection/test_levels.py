"""A hand looks the same on its level at any distance, and every pixel of it is looked at once."""

import numpy as np

from tests.tracker.detection.toys import FOCAL, disc_image
from tracker.detection.channels import CHANNELS
from tracker.detection.levels import FAR, LEVEL_RATIO, NOTHING, PAD, build_levels
from tracker.detection.patch_image import PatchImage

PIXEL = 0.003


def plane(depth: float, size: tuple[int, int] = (60, 80), focal: float = FOCAL) -> PatchImage:
    return PatchImage(np.full(size, depth, dtype=np.float32), np.ones(size, dtype=bool), focal)


def test_a_pixel_of_a_level_is_as_wide_as_asked_at_its_depth():
    for depth in (0.3, 0.6, 1.1):
        (level,) = build_levels(plane(depth), "depth", PIXEL)
        assert np.isclose(level.spacing * depth / FOCAL, PIXEL)
        assert level.channels.shape == (*(np.array(level.depth_image.shape) + 2 * PAD), CHANNELS)
        np.testing.assert_allclose(level.depths, depth, rtol=1e-6)


def test_levels_share_the_pixels_by_depth_and_leave_none_out():
    depth = np.repeat(np.linspace(0.3, 0.9, 120, dtype=np.float32)[None], 60, axis=0)
    levels = build_levels(PatchImage(depth, np.ones(depth.shape, dtype=bool), 150.0), "depth", PIXEL)
    assert len(levels) == int(np.ceil(np.log(3.0) / np.log(LEVEL_RATIO)))
    covered = np.zeros(len(levels))
    for number, level in enumerate(levels):
        assert (np.abs(np.log(level.depths / level.depth)) < 0.5 * np.log(LEVEL_RATIO) + 0.02).all()
        covered[number] = len(level.centers) * level.spacing**2
    assert 0.9 < covered.sum() / depth.size < 1.1


def test_means_of_whole_pixels_are_plain_means():
    rng = np.random.default_rng(0)
    depth = rng.uniform(0.5, 0.501, (12, 18)).astype(np.float32)
    depth[:3, :3] = 0.0
    depth[3, 3] = 0.0
    image = PatchImage(depth, np.ones(depth.shape, dtype=bool), 3.0 * 0.5005 / PIXEL)
    (level,) = build_levels(image, "depth", PIXEL)
    assert np.isclose(level.spacing, 3.0, atol=0.01)
    blocks = depth.reshape(4, 3, 6, 3).transpose(0, 2, 1, 3).reshape(4, 6, 9)
    known = np.where(blocks > 0, blocks, np.nan)
    with np.errstate(invalid="ignore"):
        plain = np.where((blocks > 0).sum(axis=2) >= 5, np.nanmean(np.where(np.isnan(known), 0.5, known), axis=2), 0.0)
    assert level.depth_image[0, 0] == 0.0
    np.testing.assert_allclose(level.depth_image[1:4, 2:6], plain[1:, 2:], atol=1e-6)


def test_depth_becomes_grey_in_steps_and_nothing_is_farther_than_everything():
    depth = np.full((40, 40), 0.5, dtype=np.float32)
    depth[:, 20:] = 0.0
    (level,) = build_levels(PatchImage(depth, depth > 0, FOCAL), "depth", PIXEL)
    lowest = level.channels[PAD:-PAD, PAD:-PAD, 0]
    assert set(np.unique(lowest)) == {125, NOTHING}
    assert level.channels[0, 0, 0] == NOTHING > FAR


def test_patches_are_centred_on_the_mask_and_every_other_with_a_stride():
    image, _ = disc_image(np.random.default_rng(1))
    half = PatchImage(image.depth, np.arange(160)[None] * np.ones((120, 1)) < 80, FOCAL)
    (level,) = build_levels(half, "depth", PIXEL)
    assert level.centers[:, 1].max() * level.spacing < 80
    (thin,) = build_levels(half, "depth", PIXEL, stride=2)
    assert not (thin.centers % 2).any()
    assert 0.2 < len(thin.centers) / len(level.centers) < 0.3


def test_no_depth_no_levels_and_too_far_none_either():
    assert build_levels(plane(0.0), "depth", PIXEL) == []
    assert build_levels(plane(5.0), "depth", PIXEL) == []
    empty = PatchImage(np.full((10, 10), 0.5, np.float32), np.zeros((10, 10), bool), FOCAL)
    assert build_levels(empty, "depth", PIXEL) == []


def test_colour_is_seen_as_intensity_and_depth_gives_the_scale(rng):
    color = rng.integers(0, 255, (60, 80, 3), dtype=np.uint8)
    color[:, :40] = 255
    image = PatchImage(np.full((60, 80), 0.5, np.float32), np.ones((60, 80), bool), FOCAL, color)
    (level,) = build_levels(image, "color", PIXEL)
    assert np.isclose(level.spacing, PIXEL * FOCAL / 0.5)
    assert (level.channels[PAD:-PAD, PAD : PAD + 20, 0] == 255).all()

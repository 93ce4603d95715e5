"""The structured-light sensor's noise is the noise its docstring states."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.synthesis.sensor import StructuredLight

FX = 525.0


def wall(z: float, height: int = 240, width: int = 320) -> tuple[np.ndarray, np.ndarray]:
    """A wall at depth z, m, seen straight on, that fills the image but for a frame of 8 px."""
    depth = np.zeros((height, width))
    depth[8:-8, 8:-8] = z
    return depth, np.ones_like(depth)


def interior(image: np.ndarray) -> np.ndarray:
    return image[20:-20, 20:-20]


@pytest.mark.parametrize("z", [0.4, 0.5, 0.8, 1.2])
def test_noise_on_a_wall_has_the_stated_standard_deviation(z, rng):
    sensor = StructuredLight()
    reported = interior(sensor.measure(*wall(z), FX, rng))
    values = reported[reported > 0]
    step = z**2 * sensor.disparity_step / (FX * sensor.baseline)
    expected = np.hypot(sensor.axial_std(np.array(z)), step / np.sqrt(12.0))
    assert np.std(values) == pytest.approx(float(expected), rel=0.03)
    assert np.mean(values) == pytest.approx(z, abs=2e-4)


def test_reported_depths_are_whole_steps_of_disparity(rng):
    sensor = StructuredLight()
    reported = sensor.measure(*wall(0.7), FX, rng)
    steps = FX * sensor.baseline / reported[reported > 0] / sensor.disparity_step
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-9)


def test_same_seed_gives_same_image_and_another_seed_another():
    sensor = StructuredLight()
    first, again, other = (sensor.measure(*wall(0.6), FX, np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)


def test_few_pixels_are_lost_in_front_and_all_at_grazing_angles(rng):
    sensor = StructuredLight()
    depth, cosine = wall(0.6)
    assert np.mean(interior(sensor.measure(depth, cosine, FX, rng)) == 0) == pytest.approx(0.001, abs=0.001)
    assert not np.any(sensor.measure(depth, np.full_like(cosine, 0.1), FX, rng))
    half = np.mean(interior(sensor.measure(depth, np.full_like(cosine, 0.225), FX, rng)) == 0)
    assert half == pytest.approx(0.5, abs=0.02)


def test_the_projector_leaves_a_shadow_to_the_left_of_what_is_near_as_wide_as_the_disparities_differ(rng):
    sensor = StructuredLight(lateral=0.0, edge_loss=0.0, random_loss=0.0)
    depth = np.full((40, 320), 1.0)
    depth[:, 200:240] = 0.5
    is_lost = np.mean(sensor.measure(depth, np.ones_like(depth), FX, rng) == 0, axis=0)
    width = round(FX * sensor.baseline * (1 / 0.5 - 1 / 1.0))
    assert width == 39
    np.testing.assert_array_equal(np.flatnonzero(is_lost == 1), np.arange(200 - width, 200))
    np.testing.assert_array_equal(is_lost[200:], 0)


def test_edges_fray_by_a_pixel_or_two_and_no_more(rng):
    sensor = StructuredLight(random_loss=0.0)
    depth, cosine = wall(0.6)
    reported = sensor.measure(depth, cosine, FX, rng) > 0
    assert not reported[:4].any(), "nothing is seen 5 px outside of the wall"
    assert 0.02 < np.mean(reported[7, 20:-20]) < 0.5, "some of the row just outside is"
    assert 0.3 < np.mean(reported[8, 20:-20]) < 0.9, "some of the outermost row is lost"
    assert np.all(reported[14:-14, 14:-14]), "nothing is lost further in"


def test_nothing_before_the_camera_gives_an_empty_image(rng):
    assert not StructuredLight().measure(np.zeros((10, 10)), np.zeros((10, 10)), FX, rng).any()

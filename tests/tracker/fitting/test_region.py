"""Where a scene is looked for: around all of it, inside the image, wherever the camera stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.region import (
    DEPTH_MARGIN,
    FINENESS,
    MARGIN,
    SMALLEST,
    choose_stride,
    depth_range,
    is_outgrown,
    region_around,
    region_around_joints,
    whole_image,
)
from tracker.geometry import se3
from tracker.observation import Region

CAMERA = Camera("cam0", 320, 240, np.array([[300.0, 0, 159.5], [0, 300.0, 119.5], [0, 0, 1]]))


@pytest.fixture
def cloud(rng) -> np.ndarray:
    """(50, 3) a hand's worth of points half a metre before the camera, m."""
    return rng.uniform((-0.06, -0.06, 0.44), (0.06, 0.06, 0.56), (50, 3))


def edges(region: Region) -> np.ndarray:
    """First and last column, first and last row."""
    return np.array([region.column, region.column + region.width - 1, region.row, region.row + region.height - 1])


def test_all_of_the_scene_is_inside_with_its_margin_on_every_side(cloud):
    region = region_around(cloud, CAMERA)
    assert region is not None
    columns, rows = CAMERA.project(cloud).T
    room = MARGIN * 300.0 / np.median(cloud[:, 2])
    left, right, top, bottom = edges(region)
    for distance in (columns.min() - left, right - columns.max(), rows.min() - top, bottom - rows.max()):
        assert room - 1.0 <= distance <= room + 1.0
    assert region.near == pytest.approx(cloud[:, 2].min() - DEPTH_MARGIN)
    assert region.far == pytest.approx(cloud[:, 2].max() + DEPTH_MARGIN)


def test_scene_and_camera_moved_together_have_the_same_region(cloud):
    here = region_around(cloud, CAMERA)
    T = se3.exp(np.array([0.3, -2.0, 0.7, 0.4, 1.9, -0.6]))
    there = region_around(se3.transform(T, cloud), replace(CAMERA, T_world_camera=T))
    assert here is not None and there is not None
    assert np.abs(edges(here) - edges(there)).max() <= 1
    assert (there.near, there.far) == pytest.approx((here.near, here.far))


@pytest.mark.parametrize("aside", np.linspace(-0.4, 0.4, 9))
def test_a_region_never_leaves_the_image_and_is_none_or_large_enough(cloud, aside):
    for shift in ((aside, 0.0, 0.0), (0.0, aside, 0.0), (aside, aside, 0.0)):
        region = region_around(cloud + shift, CAMERA)
        if region is None:
            continue
        left, right, top, bottom = edges(region)
        assert min(left, top) >= 0 and right < 320 and bottom < 240
        assert min(region.width, region.height) >= SMALLEST


def test_what_is_aside_of_the_image_behind_the_camera_or_touches_it_has_no_region(cloud):
    for shift in ((1.0, 0, 0), (-1.0, 0, 0), (0, 1.0, 0), (0, -1.0, 0), (0, 0, -1.0), (0, 0, -0.5)):
        assert region_around(cloud + shift, CAMERA) is None


@pytest.fixture
def joints() -> np.ndarray:
    """(21, 2) px in the middle of the image."""
    return np.random.default_rng(1).uniform((120.0, 80.0), (200.0, 160.0), (21, 2))


def test_joints_in_the_image_are_inside_their_region_at_the_depth_that_most_of_them_show(joints):
    depth = np.full((240, 320), 0.5, dtype=np.float32)
    column, row = np.rint(joints[3]).astype(int)
    depth[row, column] = 2.0  # one joint is before the wall
    region = region_around_joints(joints, joints, depth, CAMERA, 0.05, 0.2)
    assert region is not None
    left, right, top, bottom = edges(region)
    assert left <= joints[:, 0].min() - 29 and right >= joints[:, 0].max() + 29  # 0.05 m are 30 px
    assert top <= joints[:, 1].min() - 29 and bottom >= joints[:, 1].max() + 29
    assert (region.near, region.far) == pytest.approx((0.3, 0.7))


def test_joints_without_depth_have_no_region_and_one_with_depth_is_enough(joints):
    depth = np.zeros((240, 320), dtype=np.float32)
    assert region_around_joints(joints, joints, depth, CAMERA, 0.05, 0.2) is None
    column, row = np.rint(joints[0]).astype(int)
    depth[row, column] = 0.5
    assert region_around_joints(joints, joints, depth, CAMERA, 0.05, 0.2) is not None


def test_joints_far_outside_of_the_image_have_no_region(joints):
    depth = np.full((240, 320), 0.5, dtype=np.float32)
    for shift in ((1000.0, 0), (-1000.0, 0), (0, 1000.0), (0, -1000.0)):
        assert region_around_joints(joints + shift, joints + shift, depth, CAMERA, 0.05, 0.2) is None


def test_a_region_is_outgrown_only_by_one_that_goes_half_of_the_margin_beyond_it_on_some_side():
    needed = Region(60, 80, 100, 120, 0.45, 0.55)
    room = 0.5 * MARGIN * 300.0 / 0.5
    assert not is_outgrown(needed, needed, CAMERA)
    assert not is_outgrown(whole_image(CAMERA, 0.1, 3.0), needed, CAMERA)
    for cut, outgrown in ((int(room), False), (int(room) + 1, True)):
        for smaller in (
            replace(needed, row=needed.row + cut, height=needed.height - cut),
            replace(needed, column=needed.column + cut, width=needed.width - cut),
            replace(needed, height=needed.height - cut),
            replace(needed, width=needed.width - cut),
        ):
            assert bool(is_outgrown(smaller, needed, CAMERA)) is outgrown
    for cut, outgrown in ((0.49 * DEPTH_MARGIN, False), (0.51 * DEPTH_MARGIN, True)):
        assert is_outgrown(replace(needed, near=needed.near + cut), needed, CAMERA) is outgrown
        assert is_outgrown(replace(needed, far=needed.far - cut), needed, CAMERA) is outgrown


@pytest.mark.parametrize("distance", [0.12, 0.3, 0.5, 1.0, 4.0])
def test_pixels_are_left_out_only_where_those_that_stay_are_about_as_fine_as_a_fit_can_use(distance):
    region = whole_image(CAMERA, distance - 0.02, distance + 0.02)
    stride, apart = choose_stride(region, CAMERA), distance / 300.0
    assert stride >= 1
    assert stride == 1 or stride * apart <= 1.5 * FINENESS
    assert (stride + 1) * apart > FINENESS


def test_hands_are_looked_for_from_the_nearest_thing_of_some_size_on():
    depth = np.full((240, 320), 2.0, dtype=np.float32)
    depth[:100, :100] = 0.5
    depth[200, :199] = 0.15  # specks before the camera
    near, far = depth_range(Frame(0, "cam0", None, depth))
    assert near <= 0.15 and far == pytest.approx(1.1)


@pytest.mark.parametrize("pixels", [0, 1, 199, 200, 201, 400])
def test_an_image_with_hardly_any_depth_is_looked_through_all_the_same(pixels):
    depth = np.zeros((240, 320), dtype=np.float32)
    depth.flat[:pixels] = 0.5
    near, far = depth_range(Frame(0, "cam0", None, depth))
    assert near <= 0.5 <= far

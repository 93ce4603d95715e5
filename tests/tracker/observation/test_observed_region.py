"""A region of a frame is the frame there: same rays, same depth, and the nearest pixels that a search of all finds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.errors import FrameError
from tracker.observation import HAND, OTHER, Preprocessing, Region, observe, undistort
from tracker.observation.observation import _nearest

K = np.array([[150.0, 0.0, 79.5], [0.0, 150.0, 59.5], [0.0, 0.0, 1.0]])
CAMERA = Camera("cam0", 160, 120, K)
RAW = Preprocessing(bilateral_diameter=0)
regions = st.builds(
    Region, st.integers(0, 60), st.integers(0, 90), st.integers(5, 60), st.integers(5, 70), st.just(0.3), st.just(0.8)
)


def slope() -> np.ndarray:
    """(120, 160) float32 m: a plane that is nearer on the left, with a far wall on its right."""
    depth = np.tile(np.linspace(0.4, 0.9, 160, dtype=np.float32), (120, 1))
    depth[:, 140:] = 2.0
    return depth


@settings(max_examples=40, deadline=None)
@given(regions, st.integers(1, 3))
def test_points_of_a_region_lie_on_the_rays_of_the_whole_image(region, stride) -> None:
    seen = observe(Frame(0, "cam0", None, slope()), CAMERA, region, RAW, stride)
    rows, columns = np.nonzero(seen.depth)
    whole = np.column_stack([region.column + stride * columns, region.row + stride * rows])
    rays = np.column_stack([(whole - K[:2, 2]) / 150.0, np.ones(len(whole))])
    z = slope()[whole[:, 1], whole[:, 0]]
    assert np.array_equal(seen.depth[rows, columns], z)
    assert np.allclose(seen.points[rows, columns], rays * z[:, None], atol=1e-6)
    assert np.allclose(
        (seen.points[rows, columns] @ seen.K.T)[:, :2] / z[:, None], np.column_stack([columns, rows]), atol=1e-3
    )


@settings(max_examples=40, deadline=None)
@given(regions)
def test_only_what_lies_in_the_depth_range_is_seen_and_without_colour_it_may_be_either(region) -> None:
    seen = observe(Frame(0, "cam0", None, slope()), CAMERA, region, RAW)
    inside = (seen.depth >= region.near) & (seen.depth <= region.far)
    assert np.array_equal(seen.labels, np.where(inside, HAND | OTHER, 0)) and seen.hand_count == inside.sum()
    assert not seen.depth[~inside].any()


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.3))
def test_nearest_pixels_are_nearest_within_what_the_chamfer_distance_is_off_by(seed, share) -> None:
    """A plain twin: all distances."""
    mask = (np.random.default_rng(seed).random((14, 18)) < share).astype(np.uint8)
    nearest = _nearest(mask)
    places = np.argwhere(mask)
    if not len(places):
        assert (nearest == -1).all()
        return
    assert mask[nearest[..., 0], nearest[..., 1]].all(), "they are pixels of the mask"
    grid = np.stack(np.mgrid[:14, :18], axis=2)
    exact = np.linalg.norm(grid[:, :, None] - places, axis=3).min(axis=2)
    found = np.linalg.norm(grid - nearest, axis=2)
    assert (found <= 1.03 * exact + 0.2).all()
    assert np.array_equal(nearest[mask > 0], places)


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 4))
def test_a_thinned_observation_is_every_so_many_pixel_with_the_same_rays(stride) -> None:
    seen = observe(Frame(0, "cam0", None, slope()), CAMERA, Region(3, 5, 60, 80, 0.3, 0.8), RAW)
    thin = seen.thin(stride)
    assert np.array_equal(thin.points, seen.points[::stride, ::stride]) and (thin.nearest_pixel == -1).all()
    rows, columns = np.nonzero(thin.depth)
    points = thin.points[rows, columns]
    assert np.allclose((points @ thin.K.T)[:, :2] / points[:, 2:], np.column_stack([columns, rows]), atol=1e-3)


@settings(max_examples=20, deadline=None)
@given(st.integers(50, 20_000))
def test_an_observation_thinned_to_a_number_has_about_so_many_pixels_or_all(count) -> None:
    seen = observe(Frame(0, "cam0", None, slope()), CAMERA, Region(0, 0, 120, 100, 0.3, 0.8), RAW)
    thin = seen.thin_to(count)
    share = thin.hand_count / min(count, seen.hand_count)
    assert 0.4 < share < 2.3 and (share == 1.0 or count < seen.hand_count)


def test_smoothing_takes_noise_off_a_plane_and_leaves_the_step_beside_it() -> None:
    rng = np.random.default_rng(0)
    depth = np.where(np.arange(160) < 80, 0.5, 0.6).astype(np.float32) + rng.normal(0, 2e-3, (120, 160))
    region = Region(0, 0, 120, 160, 0.3, 0.8)
    raw, smooth = (
        observe(Frame(0, "cam0", None, depth.astype(np.float32)), CAMERA, region, how).depth
        for how in (RAW, Preprocessing())
    )
    assert smooth[20:100, 10:70].std() < 0.6 * raw[20:100, 10:70].std()
    assert np.abs(smooth[20:100, 78] - 0.5).max() < 0.01 and np.abs(smooth[20:100, 81] - 0.6).max() < 0.01


def test_hands_that_somebody_marked_count_instead_of_colour() -> None:
    is_hand = np.zeros((120, 160), dtype=bool)
    is_hand[:, :50] = True
    frame = Frame(0, "cam0", np.full((120, 160, 3), 90, np.uint8), slope(), is_hand)
    seen = observe(frame, CAMERA, Region(0, 0, 120, 100, 0.3, 0.8), RAW)
    assert (seen.labels[:, :50][seen.depth[:, :50] > 0] == HAND).all()
    assert (seen.labels[:, 50:][seen.depth[:, 50:] > 0] == OTHER).all()


@pytest.mark.parametrize(
    ("depth", "said"), [(None, "has no depth"), (np.zeros((60, 80), np.float32), "depth is 80x60, the camera 160x120")]
)
def test_a_frame_without_depth_or_of_another_size_is_refused(depth, said) -> None:
    with pytest.raises(FrameError, match=said):
        observe(Frame(4, "cam0", None, depth), CAMERA, Region(0, 0, 10, 10, 0.3, 0.8), RAW)


def test_an_ideal_lens_changes_nothing_and_a_bent_one_is_straightened() -> None:
    frame = Frame(0, "cam0", None, slope())
    assert undistort(frame, CAMERA) == (frame, CAMERA)
    bent = Camera("cam0", 160, 120, K, np.array([-0.3, 0.1, 0.0, 0.0, 0.0]))
    straight, ideal = undistort(frame, bent)
    assert ideal.distortion.size == 0 and np.array_equal(ideal.K, K)
    assert straight.depth is not None and frame.depth is not None
    for column, row in ((30, 20), (120, 90), (80, 60)):
        ray = np.array([[(column - K[0, 2]) / 150.0, (row - K[1, 2]) / 150.0, 1.0]])
        x, y = np.rint(bent.project(ray)[0]).astype(int)
        assert abs(straight.depth[row, column] - frame.depth[y, x]) < 0.005, "nearest pixels, a few mm apart"

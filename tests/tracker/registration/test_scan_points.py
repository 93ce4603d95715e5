"""Which points of a scan are fitted: no object, no loose bits, and any first of them spread over the surface."""

import numpy as np
import pytest

from tracker.capture.scan import Scan
from tracker.registration.scan_points import MAX_GREEN_SHARE, ScanPoints, arrange_points, find_hand_points


def make_grid(count: int, size: float, at: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A flat square of count x count points and its triangles, m."""
    x, y = np.meshgrid(np.linspace(0.0, size, count), np.linspace(0.0, size, count), indexing="ij")
    points = np.stack([x.ravel() + at, y.ravel(), np.zeros(count * count)], axis=1)
    ids = np.arange(count * count).reshape(count, count)
    a, b, c, d = ids[:-1, :-1].ravel(), ids[1:, :-1].ravel(), ids[1:, 1:].ravel(), ids[:-1, 1:].ravel()
    return points, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def make_scan(points, faces=None, colors=None) -> Scan:
    return Scan(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), faces, colors)


def test_loose_bits_are_left_out_and_counted():
    points, faces = make_grid(40, 0.1)
    bit, bit_faces = make_grid(2, 0.002, at=0.3)
    scan = make_scan(np.concatenate([points, bit]), np.concatenate([faces, bit_faces + len(points)]))
    keep, notes = find_hand_points(scan)
    assert keep[:1600].all() and not keep[1600:].any()
    assert notes == ["4 points lie in 1 loose bits"]


def test_two_halves_of_a_hand_are_both_kept():
    points, faces = make_grid(20, 0.05)
    other, other_faces = make_grid(20, 0.05, at=0.2)
    scan = make_scan(np.concatenate([points, other]), np.concatenate([faces, other_faces + len(points)]))
    keep, notes = find_hand_points(scan)
    assert keep.all() and notes == []


@pytest.mark.parametrize("share", [0.3, MAX_GREEN_SHARE + 0.05])
def test_green_points_are_an_object_unless_nearly_all_are_green(share):
    points, _ = make_grid(20, 0.1)
    colors = np.full((400, 3), (200, 150, 130), dtype=np.uint8)
    green = int(400 * share)
    colors[:green] = (40, 160, 50)
    keep, notes = find_hand_points(make_scan(points, colors=colors))
    assert int((~keep).sum()) == (green if share < MAX_GREEN_SHARE else 0)
    assert len(notes) == 1 and ("was not used" in notes[0]) == (share > MAX_GREEN_SHARE)


def test_dark_green_noise_and_unused_colours_leave_nothing_out():
    points, _ = make_grid(20, 0.1)
    colors = np.tile(np.array([[10, 20, 5]], dtype=np.uint8), (400, 1))
    assert find_hand_points(make_scan(points, colors=colors))[0].all()
    colors[:] = (40, 160, 50)
    assert find_hand_points(make_scan(points, colors=colors), use_colors=False)[0].all()


def test_points_that_are_no_numbers_are_left_out_and_said():
    points, _ = make_grid(20, 0.1)
    points[3] = np.nan
    keep, notes = find_hand_points(make_scan(points))
    assert not keep[3] and int(keep.sum()) == 399 and notes == ["1 points are not finite"]


def test_points_are_drawn_by_the_area_they_stand_for():
    fine, fine_faces = make_grid(60, 0.05)
    coarse, coarse_faces = make_grid(20, 0.05, at=0.2)
    points = np.concatenate([fine, coarse])
    scan = make_scan(points, np.concatenate([fine_faces, coarse_faces + len(fine)]))
    chosen = arrange_points(scan, np.ones(len(points), dtype=bool), 200)
    assert len(chosen.points) == 200
    assert 0.35 < (chosen.points[:, 0] > 0.1).mean() < 0.65


def test_the_same_scan_gives_the_same_points_however_it_lies():
    points, faces = make_grid(30, 0.1)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    keep = np.ones(len(points), dtype=bool)
    chosen = arrange_points(make_scan(points, faces), keep, 300).points
    turned = arrange_points(make_scan(points @ turn.T, faces), keep, 300).points
    assert turned == pytest.approx(chosen @ turn.T, abs=1e-12)


def test_the_first_points_know_the_surface_of_all():
    rng = np.random.default_rng(0)
    points = ScanPoints(rng.normal(size=(9000, 3)), np.zeros((9000, 3)))
    first = points.first(100)
    assert (first.points == points.points[:100]).all()
    assert len(first.surface.points) == len(points.surface.points) == 6000
    assert first.first(10).surface is first.surface
    assert points.first(10_000) is points
    assert points.mirrored().points == pytest.approx(points.points * [-1.0, 1.0, 1.0])

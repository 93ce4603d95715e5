"""What is left out of a scan: beyond a plane, inside or outside a line that somebody drew."""

from __future__ import annotations

import numpy as np
import pytest

from server.errors import InvalidError
from server.scans.cropping import MOST_CORNERS_TOGETHER, check_crop, find_beyond, find_cropped, find_drawn, find_inside
from server.scans.schemas import PlaneStroke, PolygonStroke, ScanCrop
from server.scans.units import scale_strokes
from tracker import Scan

FORWARD = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0], [0, 0, 1.0, 0]])
"""A view along +z whose device coordinates are x / z and y / z."""

SQUARE = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]


def draw(removes: str = "inside", corners=SQUARE) -> PolygonStroke:
    return PolygonStroke.model_validate(
        {"kind": "polygon", "view": FORWARD.ravel().tolist(), "corners": corners, "removes": removes}
    )


def cut(offset: float, normal=(0.0, 0.0, 1.0)) -> PlaneStroke:
    return PlaneStroke.model_validate({"kind": "plane", "normal": normal, "offset": offset})


def make_scan(points: np.ndarray) -> Scan:
    return Scan(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), None, None, "points")


def test_a_plane_takes_what_lies_on_the_side_that_its_normal_shows_to() -> None:
    points = np.array([[0.0, 0, -1], [0, 0, 0.5], [0, 0, 0.6], [9, 9, 2]])
    assert find_beyond(points, cut(0.5)).tolist() == [False, False, True, True]
    assert find_beyond(points, cut(-0.5, (0.0, 0.0, -1.0))).tolist() == [True, False, False, False]


def test_a_line_takes_what_is_seen_inside_it_however_far() -> None:
    points = np.array([[0.0, 0, 1], [0.4, 0.4, 1], [0.6, 0, 1], [0.6, 0, 2], [6.0, 0, 20]])
    assert find_drawn(points, draw()).tolist() == [True, True, False, True, True]
    assert find_drawn(points, draw("outside")).tolist() == [False, False, True, False, False]


@pytest.mark.parametrize("removes", ["inside", "outside"])
def test_what_is_behind_the_camera_stays(removes: str) -> None:
    assert not find_drawn(np.array([[0.0, 0, -1], [9.0, 9, -1], [0, 0, 0]]), draw(removes)).any()


def test_strokes_add_up(rng: np.random.Generator) -> None:
    scan = make_scan(rng.uniform(-1, 1, (500, 3)) + np.array([0.0, 0.0, 2.0]))
    strokes = [draw(), cut(2.5)]
    together = find_cropped(scan, ScanCrop(strokes=strokes, drops_objects=False))
    assert np.array_equal(together, find_drawn(scan.points, strokes[0]) | find_beyond(scan.points, strokes[1]))
    assert not find_cropped(scan, ScanCrop(strokes=[], drops_objects=False)).any()


@pytest.mark.parametrize("factor", [0.001, 25.4])
def test_in_another_unit_the_same_points_go(rng: np.random.Generator, factor: float) -> None:
    points = rng.uniform(-1, 1, (500, 3)) + np.array([0.0, 0.0, 2.0])
    strokes = [draw(), draw("outside", [(-0.9, -0.9), (0.9, -0.9), (0.0, 0.9)]), cut(2.5)]
    before = find_cropped(make_scan(points), ScanCrop(strokes=strokes, drops_objects=False))
    scaled = ScanCrop(strokes=scale_strokes(strokes, factor), drops_objects=False)
    assert np.array_equal(find_cropped(make_scan(points * factor), scaled), before) and 0 < before.sum() < 500


def test_a_line_that_crosses_itself_goes_by_the_even_odd_rule() -> None:
    bow = np.array([(-1.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)])
    points = np.array([[0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5], [2.0, 0.0]])
    assert find_inside(points, bow).tolist() == [True, True, False, False, False]


def test_no_point_or_a_line_without_height_is_inside_of_nothing() -> None:
    assert find_inside(np.zeros((0, 2)), np.array(SQUARE)).tolist() == []
    assert not find_inside(np.zeros((3, 2)), np.array([(-1.0, 0.0), (1.0, 0.0), (0.5, 0.0)])).any()


def test_crops_that_cannot_be_done_are_refused_with_the_reason() -> None:
    with pytest.raises(InvalidError, match="normal is zero"):
        check_crop(ScanCrop(strokes=[cut(0.0, (0.0, 0.0, 0.0))], drops_objects=False))
    corners = [(float(n), 0.0) for n in range(500)]
    many = ScanCrop(strokes=[draw(corners=corners)] * (MOST_CORNERS_TOGETHER // 500 + 1), drops_objects=False)
    with pytest.raises(InvalidError, match=f"more than {MOST_CORNERS_TOGETHER}"):
        check_crop(many)
    check_crop(ScanCrop(strokes=[draw(), cut(0.5)], drops_objects=False))

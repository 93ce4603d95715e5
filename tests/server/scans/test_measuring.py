"""Sizes of scans before anything is stored: in the file's unit, with the unit that makes a hand of it."""

from __future__ import annotations

import base64
import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.errors import InvalidError
from server.scans.measuring import PICTURE_PX, measure_scans
from tests.server.curation import make_ball
from tracker import Scan
from tracker.capture import HAND_LENGTHS, LONGEST_SCENE
from tracker.capture.scan import save_scan


def write_box(path: Path, sides: tuple[float, float, float], seed: int = 0) -> None:
    """Points that fill a box turned somehow, whose corners are among them."""
    rng = np.random.default_rng(seed)
    corners = np.array(np.meshgrid(*([-0.5, 0.5],) * 3)).reshape(3, -1).T
    points = np.concatenate([corners, rng.uniform(-0.5, 0.5, (900, 3))]) * sides
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    save_scan(Scan(points @ turn.T, np.zeros_like(points), None, None, "box"), path)


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_sides_come_longest_first_however_the_scan_lies(tmp_path: Path, unit: float) -> None:
    write_box(tmp_path / "box.ply", (0.04 / unit, 0.2 / unit, 0.1 / unit))
    [found] = measure_scans(tmp_path).files
    assert found.size_units == sorted(found.size_units, reverse=True)
    assert found.size_units == pytest.approx([0.2 / unit, 0.1 / unit, 0.04 / unit], rel=0.15)
    assert (found.guess, found.is_certain, found.metres_per_unit) == (unit, True, None)
    assert (found.file, found.point_count) == ("box.ply", 908)


@pytest.mark.parametrize(("length", "guess"), [(7.0, 0.0254), (20.0, 0.01), (1.5, None), (70.0, None)])
def test_a_unit_is_certain_only_where_no_other_makes_a_hand_of_the_length(tmp_path: Path, length, guess) -> None:
    save_scan(make_ball(radius=length / 2), tmp_path / "ball.ply")
    [found] = measure_scans(tmp_path).files
    assert (found.guess, found.is_certain) == (guess, False)


def test_the_list_says_the_unit_and_the_size_stays_that_of_the_file(tmp_path: Path) -> None:
    save_scan(make_ball(radius=3.5), tmp_path / "ball.ply")
    (tmp_path / "scans.json").write_text(json.dumps([{"file": "ball.ply", "metres_per_unit": 0.025}]))
    [found] = measure_scans(tmp_path).files
    assert found.metres_per_unit == 0.025 and found.size_units == pytest.approx([7.0] * 3, rel=0.05)


def test_a_picture_of_each_comes_with_the_length_of_its_side(tmp_path: Path) -> None:
    write_box(tmp_path / "box.ply", (40.0, 200.0, 100.0))
    [found] = measure_scans(tmp_path).files
    head, _, data = found.picture.partition(",")
    image = cv2.imdecode(np.frombuffer(base64.b64decode(data), np.uint8), cv2.IMREAD_UNCHANGED)
    assert head == "data:image/png;base64" and image.shape[:2] == (PICTURE_PX, PICTURE_PX)
    assert 200.0 * 0.85 < found.picture_units < 200.0 * 1.5


def test_what_is_no_scan_is_named_beside_the_others_and_the_limits_are_told(tmp_path: Path) -> None:
    save_scan(make_ball(), tmp_path / "ball.ply")
    (tmp_path / "junk.ply").write_bytes(b"no scan")
    (tmp_path / "notes.txt").write_bytes(b"x")
    told = measure_scans(tmp_path)
    assert [one.file for one in told.files] == ["ball.ply"] and [one.file for one in told.refused] == ["junk.ply"]
    assert str(tmp_path) not in told.refused[0].detail and told.notes == ["1 other file was ignored."]
    assert (told.hand_lengths_m, told.longest_scene_m) == (list(HAND_LENGTHS), LONGEST_SCENE)


def test_nothing_to_measure_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidError, match="There are no scans in it"):
        measure_scans(tmp_path)

"""OBJ files: points, colours and polygons as fans; what counts beyond the file is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.scan_obj import read_obj_scan
from tracker.capture.scan_values import RawScan
from tracker.errors import ScanError

POINTS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def read(text: str | bytes) -> RawScan:
    return read_obj_scan(Path("a.obj"), text if isinstance(text, bytes) else text.encode())


@given(
    st.lists(st.lists(st.integers(0, 3), min_size=1, max_size=5), max_size=4),
    st.booleans(),
    st.sampled_from(["", "/7", "//2", "/1/2"]),
)
def test_polygons_are_fans_whether_counted_from_the_first_or_the_last_point(
    polygons, from_last: bool, more: str
) -> None:
    faces = "".join(f"f {' '.join(f'{i - 4 if from_last else i + 1}{more}' for i in p)}\n" for p in polygons)
    found = read(f"mtllib x.mtl\nvn 0 0 1\n{POINTS}{faces}")
    fans = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    assert found.points.shape == (4, 3)
    np.testing.assert_array_equal(np.zeros((0, 3)) if found.faces is None else found.faces, np.reshape(fans, (-1, 3)))


def test_colours_stand_behind_the_points() -> None:
    found = read("v 0 0 0 1 0.5 0\nv\t1 2 3 0 0 1\r\n")
    assert found.colors is not None and found.colors.tolist() == [[255, 128, 0], [0, 0, 255]]
    assert found.points.tolist() == [[0, 0, 0], [1, 2, 3]] and found.faces is None


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "no line 'v x y z'"),
        ("v 1 2\n", "different numbers"),
        ("v 1 2 3\nv 1 2\n", "different numbers"),
        ("v 1 2 three\n", "not a number"),
        (b"v 1 2 \xff\n", "not a number"),
        (POINTS + "f 1 2 5\n", "the point 5"),
        (POINTS + "f 1 2 0\n", "the point 5"),
        (POINTS + "f 1 2 -5\n", "points 1 to 4"),
        (POINTS + "f 1 2 x\n", "cannot be read"),
        (POINTS + "f 1 2 /3\n", "cannot be read"),
    ],
)
def test_what_is_no_surface_is_refused(text: str | bytes, told: str) -> None:
    with pytest.raises(ScanError, match=told):
        read(text)

"""STL files, binary and ASCII: every triangle with points of its own, and as many as the header says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tracker.capture.scan_stl import RECORD, read_stl_scan
from tracker.errors import ScanError

TRIANGLES = arrays(np.float32, st.integers(1, 4).map(lambda n: (n, 3, 3)), elements=st.floats(-9, 9, width=32))


def binary(corners: np.ndarray, head: bytes = b"", count: int | None = None) -> bytes:
    records = np.zeros(len(corners), RECORD)
    records["corners"] = corners
    return head.ljust(80) + (len(corners) if count is None else count).to_bytes(4, "little") + records.tobytes()


def ascii_of(corners: np.ndarray) -> bytes:
    rows = "".join(f"  vertex {x!r} {y!r} {z!r}\n" for x, y, z in corners.reshape(-1, 3).tolist())
    return f"\nSOLID x\n facet normal 0 0 1\n{rows}endsolid".encode()


@given(TRIANGLES)
def test_both_forms_give_the_same_triangles_and_a_binary_one_may_begin_with_solid(corners: np.ndarray) -> None:
    for data in (binary(corners), binary(corners, b"solid by name only"), ascii_of(corners)):
        found = read_stl_scan(Path("a.stl"), data)
        np.testing.assert_array_equal(found.points[found.faces], corners.astype(np.float64))


ONE = np.zeros((1, 3, 3))


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "0 bytes"),
        (binary(ONE[:0]), "0 triangles"),
        (binary(ONE)[:-1], "promises 1"),
        (binary(ONE, count=2**32 - 1), "promises 4294967295"),
        (b"solid x\n", "0 lines"),
        (b"solid x\nvertex 0 0 0\nvertex 1 0 0\n", "2 lines"),
        (b"solid x\n" + b"vertex 0 0\n" * 3, "3 lines"),
        (b"solid x\n" + b"vertex 0 0 zero\n" * 3, "not a number"),
    ],
)
def test_what_is_no_triangles_is_refused(data: bytes, told: str) -> None:
    with pytest.raises(ScanError, match=told):
        read_stl_scan(Path("a.stl"), data)

"""Scans as npz: what was packed is read again, what is not whole is refused before anything is made of it."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tracker.capture.scan_npz as scan_npz
from tracker.capture.scan_npz import pack_npz_scan, read_npz_scan
from tracker.errors import ScanError

POINTS = np.arange(12.0).reshape(4, 3)
FACES = np.array([[0, 1, 2]])


def pack(**arrays: Any) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


@given(st.integers(1, 20), st.booleans(), st.booleans())
def test_what_is_packed_is_read_again(count: int, has_faces: bool, has_colors: bool) -> None:
    random = np.random.default_rng(count)
    points, normals = random.normal(size=(2, count, 3))
    faces = random.integers(0, count, (5, 3)) if has_faces else None
    colors = random.integers(0, 256, (count, 3), dtype=np.uint8) if has_colors else None
    found = read_npz_scan(Path("a.npz"), pack_npz_scan(points, normals, faces, colors))
    for now, before in zip(
        (found.points, found.normals, found.faces, found.colors), (points, normals, faces, colors), strict=True
    ):
        np.testing.assert_array_equal(now, before)


def test_points_alone_are_a_scan() -> None:
    found = read_npz_scan(Path("a.npz"), pack(points=POINTS.astype(np.float32), else_=POINTS))
    assert found.points.tolist() == POINTS.tolist() and found.points.dtype == np.float64
    assert found.faces is None and found.normals is None and found.colors is None


@pytest.mark.parametrize(
    ("arrays", "told"),
    [
        ({"normals": POINTS}, "an npz without points"),
        ({"points": POINTS[0]}, r"points of shape \(3,\)"),
        ({"points": np.array(1.0)}, r"points of shape \(\)"),
        ({"points": POINTS[:, :2]}, r"points of shape \(4, 2\)"),
        ({"points": POINTS.astype(str)}, "points of shape"),
        ({"points": POINTS, "faces": FACES.astype(float)}, "faces of shape"),
        ({"points": POINTS, "normals": POINTS[:3]}, "3 normals for 4 points"),
        ({"points": POINTS, "colors": POINTS[:1]}, "1 colors for 4 points"),
        ({"points": np.array([[None] * 3])}, "a damaged file"),
    ],
)
def test_arrays_that_are_no_scan_are_refused(arrays: dict, told: str) -> None:
    with pytest.raises(ScanError, match=told):
        read_npz_scan(Path("a.npz"), pack(**arrays))


@pytest.mark.parametrize(("limit", "most"), [("MAX_FILE_BYTES", 100), ("MAX_FILE_POINTS", 3), ("MAX_FILE_FACES", 0)])
def test_what_is_too_large_is_refused(limit: str, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    data = pack_npz_scan(POINTS, POINTS, FACES, None)
    read_npz_scan(Path("a.npz"), data)
    monkeypatch.setattr(scan_npz, limit, most)
    with pytest.raises(ScanError, match="at most"):
        read_npz_scan(Path("a.npz"), data)


@given(st.integers(0, 10**6))
def test_a_file_that_was_cut_off_is_refused(length: int) -> None:
    data = pack(points=POINTS)
    with pytest.raises(ScanError):
        read_npz_scan(Path("a.npz"), data[: length % len(data)])

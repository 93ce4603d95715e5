"""PLY files, ASCII and binary of both byte orders: what was written comes back, what a head only claims does not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tracker.capture.scan_ply import TYPES, read_ply_scan, write_ply
from tracker.capture.scan_values import RawScan
from tracker.errors import ScanError

PATH = Path("a.ply")
POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0]], float)


def head(order: str, *lines: str) -> bytes:
    return "\n".join(["ply", f"format {order} 1.0", *lines, "end_header", ""]).encode()


def read(data: bytes) -> RawScan:
    return read_ply_scan(PATH, data)


@given(st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]), st.sampled_from(sorted(TYPES)))
def test_points_of_every_type_and_byte_order_come_back_beside_other_properties(order: str, kind: str) -> None:
    values = np.arange(12).reshape(4, 3)
    lines = ["element vertex 4", "property double other", *(f"property {kind} {axis}" for axis in "zyx")]
    if order == "ascii":
        body = "\n".join(f"7 {x} {y} {z}" for x, y, z in values).encode()
    else:
        sign = "<" if "little" in order else ">"
        table = np.zeros(4, [("other", sign + "f8"), *((axis, sign + TYPES[kind]) for axis in "zyx")])
        for axis, column in zip("zyx", values.T, strict=True):
            table[axis] = column
        body = table.tobytes()
    np.testing.assert_array_equal(read(head(order, *lines) + body).points, values[:, ::-1])


POLYGONS = st.lists(st.lists(st.integers(0, 4), max_size=6), max_size=5)


@given(POLYGONS, st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]), st.booleans(), st.booleans())
@example([[0, 1, 2], [2, 3, 4]], "binary_big_endian", True, True)
@example([[0, 1, 2], [0, 1, 2, 3]], "binary_little_endian", True, True)
def test_polygons_are_fans_also_between_other_properties(polygons, order: str, before: bool, after: bool) -> None:
    lines = [f"element vertex {len(POINTS)}", *(f"property float {axis}" for axis in "xyz")]
    lines += [f"element face {len(polygons)}", *["property uchar flag"] * before]
    lines += ["property list uchar int vertex_indices", *["property double weight"] * after]
    lines += ["element edge 1", "property int vertex1"]
    if order == "ascii":
        rows = [" ".join(map(str, point)) for point in POINTS]
        rows += [" ".join(map(str, [*[9] * before, len(p), *p, *[0.5] * after])) for p in polygons]
        body = "\n".join([*rows, "3"]).encode()
    else:
        sign = "<" if "little" in order else ">"
        body = POINTS.astype(sign + "f4").tobytes()
        for polygon in polygons:
            body += b"\x09" * before + bytes([len(polygon)]) + np.array(polygon, sign + "i4").tobytes()
            body += np.array([0.5] * after, sign + "f8").tobytes()
        body += np.array([3], sign + "i4").tobytes()
    fans = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    found = read(head(order, *lines) + body)
    np.testing.assert_array_equal(found.faces, np.reshape(fans, (-1, 3)))
    np.testing.assert_array_equal(found.points, POINTS)


def test_what_is_written_is_read_again() -> None:
    normals, colors = np.tile([0.0, 0.0, 1.0], (5, 1)), np.arange(15, dtype=np.uint8).reshape(5, 3)
    found = read(write_ply(POINTS, np.array([[0, 1, 2]]), normals, colors))
    for now, before in zip(found, (POINTS, [[0, 1, 2]], normals, colors), strict=True):
        np.testing.assert_array_equal(now, before)
    alone = read(write_ply(POINTS, None))
    assert alone.faces is None and alone.normals is None and alone.colors is None


@pytest.mark.parametrize(
    ("kind", "values"), [("float", "0 0.5 1"), ("uchar", "0 128 255"), ("ushort", "0 32768 65535")]
)
def test_colours_of_every_depth_are_bytes(kind: str, values: str) -> None:
    lines = ["element vertex 1", *(f"property float {axis}" for axis in "xyz")]
    lines += [f"property {kind} {name}" for name in ("red", "green", "blue")]
    assert read(head("ascii", *lines) + f"0 0 0 {values}".encode()).colors.tolist() == [[0, 128, 255]]


@given(st.integers(0, 400))
def test_a_file_that_was_cut_off_is_refused(length: int) -> None:
    data = write_ply(POINTS, np.array([[0, 1, 2], [2, 3, 4]]))
    if length < len(data):
        with pytest.raises(ScanError):
            read(data[:length])


VERTEX = ("property float x", "property float y", "property float z")
LIST = "property list uchar int vertex_indices"


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"plyx\n", "no line 'ply'"),
        (b"ply\nformat ascii 1.0\n", "header without end"),
        (b"ply\n" + b"comment x\n" * 7000 + b"end_header\n", "header without end"),
        (head("binary_middle_endian", "element vertex 1", *VERTEX), "no known format"),
        (head("ascii", "element vertex 99999999999", *VERTEX), "at most 20000000"),
        (head("ascii", "element vertex -1", *VERTEX), "element vertex -1"),
        (head("ascii", "element vertex 1"), "without properties"),
        (head("ascii", "element vertex 1", *VERTEX, "property float x"), "two properties of one name"),
        (head("ascii", "property float x"), "property float x"),
        (head("ascii", "element vertex 1", "property half x"), "property half x"),
        (head("ascii", "element vertex 1", *VERTEX[:2]) + b"0 0", "x, y and z"),
        (head("ascii", "element vertex 2", *VERTEX) + b"0 0 0 1", "4 values"),
        (head("ascii", "element vertex 1", *VERTEX) + b"0 0 zero", "not a number"),
        (head("binary_little_endian", "element vertex 20000000", *VERTEX) + bytes(99), "240000"),
        (head("ascii", "element face 1", LIST, LIST + "2") + b"0 0", "2 lists"),
        (head("ascii", "element face 1", LIST) + b"-1", "cannot be read"),
        (head("ascii", "element face 1", LIST) + b"4000000000 1 2 3", "cannot be read"),
        (head("ascii", "element face 1", LIST) + b"3 0 1 99999999999999999999", "cannot be read"),
        (head("binary_big_endian", "element face 1", "property list char int i") + b"\xff" + bytes(12), "a list of -1"),
        (
            head("binary_big_endian", "element face 1", "property list uint int i") + b"\xff" * 16,
            "a list of 4294967295",
        ),
        (head("binary_big_endian", "element face 3", LIST) + b"\0", "more, for its 3 x face"),
    ],
)
def test_a_head_that_claims_what_is_not_there_is_refused(data: bytes, told: str) -> None:
    with pytest.raises(ScanError, match=told):
        read(data)

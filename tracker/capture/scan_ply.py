"""PLY files, ASCII and binary of either byte order: points, normals, colours, triangles."""

from __future__ import annotations

import io
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tracker.capture.scan_values import MAX_FILE_FACES, MAX_FILE_POINTS, RawScan, to_bytes_of_color
from tracker.errors import ScanError

NEEDED = "a PLY whose element 'vertex' has x, y, z, and perhaps faces as lists of points"

MAX_HEADER = 65536
"""Bytes; a bound of ours."""

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip


class Element(NamedTuple):
    """An element of the header: its name, count and properties; those of a list have a type of their count."""

    name: str
    count: int
    properties: list[tuple[str, str, str]]


def read_ply_scan(path: Path, data: bytes) -> RawScan:
    """Read vertices and faces (polygons as fans); other elements are skipped."""
    order, elements, start = _read_header(path, data)
    vertex: npt.NDArray | None = None
    faces: npt.NDArray[np.int64] | None = None
    words = data[start:].split() if order == "" else []
    place = 0 if order == "" else start
    for element in elements:
        if any(count for _, _, count in element.properties):
            lists, place = _read_lists(path, element, data, words, order, place)
            if element.name == "face":
                faces = lists
        else:
            table, place = _read_table(path, element, data, words, order, place)
            if element.name == "vertex":
                vertex = table
    if vertex is None or vertex.dtype.names is None or not {"x", "y", "z"} <= set(vertex.dtype.names):
        raise ScanError(path, "no vertices with x, y and z", NEEDED)
    return RawScan(
        points=_columns(vertex, ("x", "y", "z")).astype(np.float64),
        faces=faces,
        normals=_columns(vertex, ("nx", "ny", "nz")).astype(np.float64) if _has(vertex, "nx", "ny", "nz") else None,
        colors=_find_colors(vertex),
    )


def write_ply(
    points: npt.NDArray[np.float64],
    faces: npt.NDArray | None,
    normals: npt.NDArray[np.float64] | None = None,
    colors: npt.NDArray[np.uint8] | None = None,
) -> bytes:
    """The bytes of a binary little-endian PLY: points (N, 3) in m as float32, faces (F, 3), normals, colours."""
    fields = [(axis, "<f4", points[:, k]) for k, axis in enumerate("xyz")]
    if normals is not None:
        fields += [(f"n{axis}", "<f4", normals[:, k]) for k, axis in enumerate("xyz")]
    if colors is not None:
        fields += [(name, "u1", colors[:, k]) for k, name in enumerate(("red", "green", "blue"))]
    table = np.empty(len(points), np.dtype([(name, kind) for name, kind, _ in fields]))
    for name, _, column in fields:
        table[name] = column
    lines = ["ply", "format binary_little_endian 1.0", "comment metres", f"element vertex {len(points)}"]
    lines += [f"property {'uchar' if kind == 'u1' else 'float'} {name}" for name, kind, _ in fields]
    tail = b""
    if faces is not None:
        lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
        rows = np.empty(len(faces), np.dtype([("count", "u1"), ("ids", "<i4", 3)]))
        rows["count"], rows["ids"] = 3, faces
        tail = rows.tobytes()
    return ("\n".join([*lines, "end_header"]) + "\n").encode() + table.tobytes() + tail


def _read_header(path: Path, data: bytes) -> tuple[str, list[Element], int]:
    """Byte order ("<", ">", or "" for ASCII), elements, and where they begin."""
    stream = io.BytesIO(data[:MAX_HEADER])
    if stream.readline().strip() != b"ply":
        raise ScanError(path, "no line 'ply' at its beginning", NEEDED)
    order: str | None = None
    elements: list[Element] = []
    while (words := _read_words(path, stream))[0] != "end_header":
        if words[0] == "format" and len(words) > 1:
            order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}.get(words[1])
        elif words[0] == "element" and len(words) == 3 and words[2].isdigit() and len(words[2]) < 12:
            elements.append(Element(words[1], int(words[2]), []))
        elif elements and (found := _parse_property(words)):
            elements[-1].properties.append(found)
        else:
            raise ScanError(path, f"the line {' '.join(words)[:60]!r} in its header", NEEDED)
    if order is None:
        raise ScanError(path, "no known format", "ascii, binary_little_endian or binary_big_endian")
    for element in elements:
        _check_element(path, element)
    return order, elements, stream.tell()


def _read_words(path: Path, stream: io.BytesIO) -> list[str]:
    """Words of the next line of the header that is neither empty nor a comment."""
    while True:
        line = stream.readline()
        if not line or stream.tell() >= MAX_HEADER:
            raise ScanError(path, "a header without end", NEEDED)
        words = line.decode("ascii", "replace").split()
        if words and words[0] not in ("comment", "obj_info"):
            return words


def _parse_property(words: list[str]) -> tuple[str, str, str] | None:
    """Name, type and, of a list, type of its count; None where the line is no property of a known type."""
    match words:
        case ["property", kind, name] if kind in TYPES:
            return name, TYPES[kind], ""
        case ["property", "list", count, kind, name] if count in TYPES and kind in TYPES:
            return name, TYPES[kind], TYPES[count]
    return None


def _check_element(path: Path, element: Element) -> None:
    limit = MAX_FILE_POINTS if element.name == "vertex" else MAX_FILE_FACES
    if element.count > limit:
        raise ScanError(path, f"{element.count} of the element {element.name}", f"at most {limit}")
    names = [name for name, _, _ in element.properties]
    if not names:
        raise ScanError(path, f"an element {element.name!r} without properties", NEEDED)
    if len(set(names)) != len(names):
        raise ScanError(path, f"two properties of one name in {names[:9]} of {element.name}", "each once")


def _read_table(path, element: Element, data: bytes, words, order: str, place: int) -> tuple[npt.NDArray, int]:
    kind = np.dtype([(name, order + kind) for name, kind, _ in element.properties])
    if order:
        end = place + kind.itemsize * element.count
        if end > len(data):
            raise ScanError(path, f"{len(data)} bytes", f"{end} for its {element.count} x {element.name}")
        return np.frombuffer(data, kind, element.count, place), end
    end = place + len(element.properties) * element.count
    if end > len(words):
        raise ScanError(path, f"{len(words)} values", f"{end} for its {element.count} x {element.name}")
    try:
        values = np.array(words[place:end], dtype=np.bytes_).astype(np.float64).reshape(element.count, -1)
    except ValueError as error:
        raise ScanError(path, f"a value that is not a number ({str(error)[:60]})", NEEDED) from error
    table = np.empty(element.count, np.dtype([(name, kind) for name, kind, _ in element.properties]))
    with np.errstate(invalid="ignore", over="ignore"):
        for k, name in enumerate(table.dtype.names or ()):
            table[name] = values[:, k]
    return table, end


def _read_lists(
    path, element: Element, data: bytes, words, order: str, place: int
) -> tuple[npt.NDArray[np.int64], int]:
    """Triangles (F, 3) of an element with one list, and what follows it."""
    lists = [k for k, (_, _, count) in enumerate(element.properties) if count]
    if len(lists) != 1:
        raise ScanError(path, f"{len(lists)} lists in {element.name}", "one")
    if not order:
        return _read_ascii_lists(path, element, words, place, lists[0])
    _, item, count = element.properties[lists[0]]
    before = sum(np.dtype(kind).itemsize for _, kind, _ in element.properties[: lists[0]])
    after = sum(np.dtype(kind).itemsize for _, kind, _ in element.properties[lists[0] + 1 :])
    row = np.dtype([("before", "V", before), ("count", order + count), ("ids", order + item, 3), ("after", "V", after)])
    end = place + row.itemsize * element.count
    if end <= len(data):
        table = np.frombuffer(data, row, element.count, place)
        if (table["count"] == 3).all():
            return table["ids"].astype(np.int64), end
    count_size, item_size = np.dtype(count).itemsize, np.dtype(item).itemsize
    triangles: list[npt.NDArray[np.int64]] = []
    for _ in range(element.count):  # polygons of several sizes: rare, and slow
        first = place + before + count_size
        if first > len(data):
            raise ScanError(path, f"{len(data)} bytes", f"more, for its {element.count} x {element.name}")
        size = int(np.frombuffer(data, order + count, 1, place + before)[0])
        place = first + size * item_size + after
        if size < 0 or place > len(data):
            raise ScanError(path, f"a list of {size}", f"one that fits into its {len(data)} bytes")
        triangles.append(_fan(np.frombuffer(data, order + item, size, first).astype(np.int64)))
    return np.concatenate([np.zeros((0, 3), dtype=np.int64), *triangles]), place


def _read_ascii_lists(path, element: Element, words, place: int, at: int) -> tuple[npt.NDArray[np.int64], int]:
    triangles = [np.zeros((0, 3), dtype=np.int64)]
    try:
        for _ in range(element.count):
            size = int(words[place + at])
            first = place + at + 1
            place = first + size + len(element.properties) - 1 - at
            if size < 0 or place > len(words):
                raise IndexError
            triangles.append(_fan(np.array([int(word) for word in words[first : first + size]], dtype=np.int64)))
    except (IndexError, ValueError, OverflowError) as error:
        raise ScanError(path, f"a list in {element.name} that cannot be read", NEEDED) from error
    return np.concatenate(triangles), place


def _fan(ids: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    count = max(len(ids) - 2, 0)
    return np.stack([np.repeat(ids[:1], count), ids[1 : 1 + count], ids[2 : 2 + count]], axis=1)


def _has(table: npt.NDArray, *names: str) -> bool:
    return set(names) <= set(table.dtype.names or ())


def _columns(table: npt.NDArray, names: tuple[str, ...]) -> npt.NDArray:
    return np.stack([table[name] for name in names], axis=1)


def _find_colors(vertex: npt.NDArray) -> npt.NDArray[np.uint8] | None:
    for names in (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue")):
        if _has(vertex, *names):
            return to_bytes_of_color(_columns(vertex, names))
    return None

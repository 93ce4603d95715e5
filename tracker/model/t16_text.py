"""The text files of a T16 model: OFF, SKEL, SKIN, LIMITS, VOI and MOTION. Lengths stay in mm, angles in degrees."""

from __future__ import annotations

import gzip
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.errors import ModelFileError, reading, reads
from tracker.model.file_limits import MAX_BYTES, MAX_VERTICES
from tracker.model.skeleton import Array

MAX_BONES = 256
"""A bound of ours."""


@dataclass(frozen=True)
class BoneLimits:
    """What a LIMITS file says of one bone.

    Attributes:
        name: As in the file; an object's may differ from its name elsewhere.
        flags: (4,) whether it may translate, and turn about axis 1, 2, 3.
        axes: (3, 3) rows, in the bone's own frame at rest.
        ranges_deg: (3, 2) lower and upper.
    """

    name: str
    flags: npt.NDArray[np.bool_]
    axes: Array
    ranges_deg: Array


def read_text(path: Path) -> list[str]:
    """Lines of a text file, gzipped or not, stripped of blanks around them."""
    begin = gzip.open if path.suffix == ".gz" else open
    with reading(ModelFileError, path, "a readable text, gzipped if its name ends so"), begin(path, "rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise ModelFileError(path, f"more than {MAX_BYTES} bytes of text", "a smaller file")
    return [line.strip() for line in data.decode("utf-8", errors="replace").splitlines()]


@reads(ModelFileError, "a valid OFF file of a T16 model")
def read_off(path: Path) -> tuple[Array, npt.NDArray[np.int64]]:
    """Vertices (V, 3), mm, and triangles (F, 3) of an ASCII OFF mesh; larger polygons are fanned."""
    head, lines = _split_off(path)
    counts = _integers(path, head, "the counts of vertices, faces and edges")
    if len(counts) < 2 or not (3 <= counts[0] <= MAX_VERTICES and 1 <= counts[1] <= 4 * MAX_VERTICES):
        raise ModelFileError(path, f"counts {counts}", f"3 to {MAX_VERTICES} vertices and at least one face")
    num_vertices, num_faces = counts[:2]
    if len(lines) < num_vertices + num_faces:
        raise ModelFileError(
            path, f"{len(lines)} lines", f"{num_vertices} vertices and {num_faces} faces, as its head says"
        )
    vertices = _numbers(path, lines[:num_vertices], 3, "a vertex")
    fans = [_read_fan(path, line) for line in lines[num_vertices : num_vertices + num_faces]]
    triangles = np.array([triangle for fan in fans for triangle in fan], dtype=np.int64)
    if triangles.min() < 0 or triangles.max() >= num_vertices:
        raise ModelFileError(path, f"a face with vertex {triangles.max()}", f"vertices 0 to {num_vertices - 1}")
    return vertices, triangles


def _split_off(path: Path) -> tuple[str, list[str]]:
    """The line of counts, which may stand behind the word OFF, and the lines after it."""
    lines = [line for line in (line.split("#")[0].strip() for line in read_text(path)) if line]
    if not lines or not lines[0].upper().startswith("OFF"):
        raise ModelFileError(path, f"the first line {_quote(lines)}", "'OFF', the start of an ASCII OFF mesh")
    beside = lines[0][3:].strip()
    if beside:
        return beside, lines[1:]
    return (lines[1], lines[2:]) if len(lines) > 1 else ("", [])


def _read_fan(path: Path, line: str) -> list[tuple[int, int, int]]:
    """Triangles of a face's line: its number of corners, then their vertices."""
    values = _integers(path, line, "a face")
    size = values[0] if values else 0
    if size < 3 or len(values) < 1 + size:
        raise ModelFileError(path, f"the face {line[:60]!r}", "its number of corners, at least 3, and their vertices")
    return [(values[1], values[k], values[k + 1]) for k in range(2, size)]


@reads(ModelFileError, "a valid SKEL file of a T16 model")
def read_skel(path: Path) -> tuple[tuple[str, ...], npt.NDArray[np.int64], Array]:
    """Names (B), parents (B,) with -1 for the root, and lengths (B,), mm, of the bones."""
    lines = [line for line in read_text(path)[1:] if line]
    if not lines or len(lines) % 3 or len(lines) > 3 * MAX_BONES:
        raise ModelFileError(
            path, f"{len(lines)} lines after the first", f"3 a bone: parent, name, length; 1 to {MAX_BONES} bones"
        )
    names = tuple(lines[1::3])
    if len(set(names)) != len(names):
        raise ModelFileError(path, "a bone named twice", "a name of its own for every bone")
    lengths = _numbers(path, lines[2::3], 1, "the length of a bone")[:, 0]
    parents = np.array([names.index(name) if name in names else -1 for name in lines[0::3]], dtype=np.int64)
    if np.any(parents >= np.arange(len(names))) or np.sum(parents < 0) != 1:
        raise ModelFileError(
            path, "bones that do not form one tree in order", "one root first, every parent before its children"
        )
    return names, parents, lengths


@reads(ModelFileError, "a valid SKIN file of a T16 model")
def read_skin(path: Path, bone_names: tuple[str, ...], num_vertices: int) -> Array:
    """Blend weights (V, B), rows summing to one, columns in the order of `bone_names`."""
    lines = [line for line in read_text(path) if line]
    if len(lines) < 2 + num_vertices:
        raise ModelFileError(
            path, f"{max(len(lines) - 2, 0)} rows of weights", f"one for each of {num_vertices} vertices"
        )
    count = _integers(path, lines[0], "the number of bones")
    if len(count) != 1 or count[0] != len(bone_names):
        raise ModelFileError(path, f"{lines[0][:40]!r} bones", f"the {len(bone_names)} bones of the .SKEL file")
    names = _split_names(lines[1], bone_names)
    if sorted(names) != sorted(bone_names):
        raise ModelFileError(
            path, f"the bones {lines[1][:80]!r}", f"the names of the .SKEL file: {', '.join(bone_names)[:200]}"
        )
    rows = _numbers(path, lines[2 : 2 + num_vertices], len(bone_names), "a row of weights")
    if rows.min() < -1e-6 or rows.sum(axis=1).min() < 0.5 or rows.sum(axis=1).max() > 1.5:
        raise ModelFileError(path, "a row of weights that is negative or far from summing to 1", "rows that sum to 1")
    weights = np.maximum(rows, 0.0)[:, [names.index(name) for name in bone_names]]
    return weights / weights.sum(axis=1, keepdims=True)


@reads(ModelFileError, "a valid LIMITS file of a T16 model")
def read_limits(path: Path) -> tuple[BoneLimits, ...]:
    """Degrees of freedom of each bone."""
    lines = [line for line in read_text(path) if line]
    if not lines or len(lines) % 8:
        raise ModelFileError(path, f"{len(lines)} lines", "8 a bone: name, 4 flags, 3 axes, 3 ranges")
    bones = []
    for start in range(0, len(lines), 8):
        flags = _numbers(path, [lines[start + 1]], 4, "the flags of a bone")[0] > 0.5
        axes = _numbers(path, lines[start + 2 : start + 5], 3, "an axis")
        ranges = _numbers(path, lines[start + 5 : start + 8], 2, "a range")
        bones.append(BoneLimits(lines[start], flags, axes, ranges))
    return tuple(bones)


@reads(ModelFileError, "a valid VOI file of a T16 model")
def read_voi(path: Path, num_vertices: int) -> npt.NDArray[np.int64]:
    """Vertices of interest (3, 5): fingertip, nail side, pad; little to thumb."""
    values = [int(value) for line in read_text(path) if line for value in _integers(path, line, "a vertex")]
    if len(values) != 15 or not all(0 <= value < num_vertices for value in values):
        raise ModelFileError(path, f"{len(values)} numbers", f"3 rows of 5 vertex numbers below {num_vertices}")
    return np.array(values, dtype=np.int64).reshape(3, 5)


@reads(ModelFileError, "a valid MOTION file of a T16 model")
def read_motion(path: Path) -> tuple[tuple[str, ...], Array]:
    """Bone names and their poses (1 + T, B, 4, 4), mm; row 0 is the bind pose."""
    names: list[str] = []
    rows: list[list[str]] = []
    for line in read_text(path):
        if not line:
            continue
        if _is_number(line.split()[0]):
            if not rows:
                raise ModelFileError(path, "numbers before the first bone", "the name of a bone, then its rows")
            rows[-1].append(line)
        else:
            names.append(line)
            rows.append([])
    counts = {len(bone_rows) for bone_rows in rows}
    if len(counts) != 1 or 0 in counts or len(names) > MAX_BONES:
        raise ModelFileError(
            path, f"{len(names)} bones with {sorted(counts)} rows", "the same number of rows, at least 1, for each bone"
        )
    values = np.stack([_numbers(path, bone_rows, 12, "a pose") for bone_rows in rows], axis=1)
    Ts = np.zeros((*values.shape[:2], 4, 4))
    Ts[..., :3, :3] = values[..., :9].reshape(*values.shape[:2], 3, 3)
    Ts[..., :3, 3] = values[..., 9:]
    Ts[..., 3, 3] = 1.0
    U, _, Vt = np.linalg.svd(Ts[..., :3, :3])
    R = U @ Vt
    if np.abs(R - Ts[..., :3, :3]).max() > 0.01 or np.linalg.det(R).min() < 0:
        raise ModelFileError(path, "a 3x3 matrix that does not rotate", "r11 r12 r13 r21 .. r33 tx ty tz in each row")
    Ts[..., :3, :3] = R
    return tuple(names), Ts


def _split_names(line: str, bone_names: tuple[str, ...]) -> list[str]:
    """Names in a line that are parted by blanks and may hold blanks themselves."""
    found = []
    rest = line.strip()
    by_length = sorted(bone_names, key=len, reverse=True)
    while rest:
        name = next((name for name in by_length if rest == name or rest.startswith(f"{name} ")), None)
        if name is None:
            return []
        found.append(name)
        rest = rest[len(name) :].strip()
    return found


def _numbers(path: Path, lines: list[str], columns: int, what: str) -> Array:
    try:
        values = np.array([[float(word) for word in line.split()[:columns]] for line in lines], dtype=np.float64)
    except ValueError as error:
        raise ModelFileError(path, f"{str(error)[:120]}", f"{columns} numbers for {what}") from error
    if values.shape != (len(lines), columns) or not np.all(np.isfinite(values)):
        raise ModelFileError(path, "a line with missing or infinite numbers", f"{columns} numbers for {what}")
    return values


def _integers(path: Path, line: str, what: str) -> list[int]:
    try:
        return [int(word) for word in line.split()]
    except ValueError as error:
        raise ModelFileError(path, f"{line[:60]!r}", f"whole numbers for {what}") from error


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _quote(lines: list[str]) -> str:
    return repr(lines[0][:40]) if lines else "missing"

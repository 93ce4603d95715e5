"""A 3D scan of a hand: points with normals, perhaps triangles and colours."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy import sparse

from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan_npz import pack_npz_scan, read_npz_scan
from tracker.capture.scan_obj import read_obj_scan
from tracker.capture.scan_ply import read_ply_scan, write_ply
from tracker.capture.scan_size import (
    LONGEST_SCENE,
    SIZES_NEEDED,
    find_possible_units,
    find_size_fault,
    is_certain,
    measure_size,
    write_length,
)
from tracker.capture.scan_stl import read_stl_scan
from tracker.capture.scan_values import MAX_FILE_BYTES, RawScan
from tracker.errors import ScanError, reads

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

READERS = {".ply": read_ply_scan, ".obj": read_obj_scan, ".stl": read_stl_scan, ".npz": read_npz_scan}

SCAN_SUFFIXES: tuple[str, ...] = tuple(READERS)

MAX_POINTS = 200_000
"""So many points are kept of a larger scan, drawn at random with the same draw every time."""

MIN_POINTS = 50
"""Fewer are no scan of a hand."""


@dataclass(frozen=True)
class Scan:
    """A scan in its own coordinates.

    Attributes:
        points: (N, 3) m.
        normals: (N, 3) unit, outwards; zero where unknown.
        faces: (F, 3) int, or None for a bare cloud.
        colors: (N, 3) uint8 red, green, blue, or None.
        name: What to call it.
    """

    points: Array
    normals: Array
    faces: Ints | None = None
    colors: npt.NDArray[np.uint8] | None = None
    name: str = "scan"

    def __post_init__(self) -> None:
        assert self.points.ndim == 2 and self.points.shape[1] == 3 and self.normals.shape == self.points.shape
        assert self.colors is None or self.colors.shape == self.points.shape

    def select(self, keep: npt.NDArray[np.bool_]) -> Scan:
        """The scan with only the points of the mask (N,) and the triangles between them."""
        faces = None
        if self.faces is not None:
            places = np.cumsum(keep) - 1
            faces = places[self.faces[keep[self.faces].all(axis=1)]]
        colors = None if self.colors is None else self.colors[keep]
        return replace(self, points=self.points[keep], normals=self.normals[keep], faces=faces, colors=colors)

    def scaled(self, factor: float) -> Scan:
        """The scan scaled by a factor, from its origin."""
        return replace(self, points=self.points * factor)

    def mirrored(self) -> Scan:
        """The scan seen in the mirror x = 0."""
        flip = np.array([-1.0, 1.0, 1.0])
        faces = None if self.faces is None else self.faces[:, ::-1]
        return replace(self, points=self.points * flip, normals=self.normals * flip, faces=faces)


def load_scan(path: Path | str, metres_per_unit: float | None = None) -> Scan:
    """Read a scan: PLY (ASCII or binary), OBJ, STL, or npz with `points` and perhaps `normals`, `faces`, `colors`.

    Equal positions are merged, points that are not finite and triangles without area are dropped; of more than
    MAX_POINTS points so many are kept (then without triangles). Normals come from the triangles where there are any.

    Args:
        path: The file.
        metres_per_unit: Length of the file's unit. When left out, metres and millimetres are told by the size; what
            may be another unit is refused.

    Raises:
        ScanError: With what was found and what is needed.
    """
    scan = read_scan(path)
    return scan.scaled(find_unit(path, scan, metres_per_unit))


@reads(ScanError, "a whole scan: PLY, OBJ, STL or npz")
def read_scan(path: Path | str) -> Scan:
    """A scan from a file, with `points` in the file's own unit."""
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ScanError(path, f"a file of the kind {path.suffix or 'without a name'}", f"one of {', '.join(READERS)}")
    size = path.stat().st_size
    if size > MAX_FILE_BYTES:
        raise ScanError(path, f"{size} bytes", f"at most {MAX_FILE_BYTES} bytes")
    raw = reader(path, path.read_bytes())
    return _clean(path, raw)


def save_scan(scan: Scan, path: Path) -> None:
    """Write a scan in metres as binary PLY (float32), or with every bit as npz, by the suffix of `path`."""
    path = Path(path)
    assert path.suffix in (".ply", ".npz"), f"{path.name}: scans are written as .ply or .npz"
    if path.suffix == ".npz":
        write_atomically(path, pack_npz_scan(scan.points, scan.normals, scan.faces, scan.colors))
    else:
        normals = scan.normals if scan.normals.any() else None
        write_atomically(path, write_ply(scan.points, scan.faces, normals, scan.colors))


def find_vertex_normals(points: Array, faces: Ints) -> Array:
    """(N, 3) unit normals, those of the triangles weighted by their area; zero for points of no triangle."""
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    ids = faces.ravel()
    gather = sparse.csr_matrix(
        (np.ones(len(ids)), (ids, np.repeat(np.arange(len(faces)), 3))), (len(points), len(faces))
    )
    return _unit(np.asarray(gather @ normals))


def _unit(vectors: Array) -> Array:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(lengths > 1e-30, vectors / np.maximum(lengths, 1e-30), 0.0)


def _clean(path: Path, raw: RawScan) -> Scan:
    points, faces = raw.points, raw.faces
    if not len(points):
        raise ScanError(path, "no points", "the points of a hand")
    if faces is not None and len(faces) and (faces.min() < 0 or faces.max() >= len(points)):
        raise ScanError(path, f"a triangle with the point {faces.max()}", f"points below {len(points)}")
    is_usable = np.asarray((np.abs(points) < 1e9).all(axis=1))  # not where a coordinate is NaN
    if is_usable.sum() < MIN_POINTS:
        found = f"{int(is_usable.sum())} finite points of {len(points)}"
        raise ScanError(path, found, f"at least {MIN_POINTS}")
    if faces is not None:
        faces = (np.cumsum(is_usable) - 1)[faces[is_usable[faces].all(axis=1)]]
    raw = raw.take(is_usable, faces)
    if len(raw.points) <= 5 * MAX_POINTS:  # merging millions of points only to thin them is waste
        raw = _merge_equal(raw)
    faces = _drop_flat(raw.faces)
    scan = Scan(raw.points, _find_normals(raw, faces), faces, raw.colors, path.stem)
    if len(scan.points) > MAX_POINTS:
        keep = np.zeros(len(scan.points), dtype=np.bool_)
        keep[np.random.default_rng(0).choice(len(scan.points), MAX_POINTS, replace=False)] = True
        scan = replace(scan, faces=None).select(keep)
    if len(scan.points) < MIN_POINTS:
        raise ScanError(path, f"{len(scan.points)} different points", f"at least {MIN_POINTS}")
    return scan if _points_outwards(scan) else replace(scan, normals=-scan.normals, faces=_reverse(scan.faces))


def _merge_equal(raw: RawScan) -> RawScan:
    _, first, inverse = np.unique(_as_keys(raw.points), return_index=True, return_inverse=True)
    return raw.take(first, None if raw.faces is None else inverse.ravel()[raw.faces])


def _drop_flat(faces: Ints | None) -> Ints | None:
    """Triangles of three different points; None where no triangle is left."""
    if faces is None:
        return None
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    return faces if len(faces) else None


def _find_normals(raw: RawScan, faces: Ints | None) -> Array:
    """(N, 3) of the triangles, else the file's own, else zero."""
    if faces is not None:
        return find_vertex_normals(raw.points, faces)
    if raw.normals is None:
        return np.zeros_like(raw.points)
    return _unit(np.where(np.isfinite(raw.normals).all(axis=1, keepdims=True), raw.normals, 0.0))


def _reverse(faces: Ints | None) -> Ints | None:
    return None if faces is None else faces[:, ::-1]


def _points_outwards(scan: Scan) -> bool:
    """Whether the normals leave the body, as the flux of (p - middle) through its surface tells."""
    offsets = scan.points - scan.points.mean(axis=0)
    return float(np.einsum("nd,nd->", offsets, scan.normals)) >= 0.0


def _as_keys(points: Array) -> npt.NDArray[np.void]:
    """(N,) one sortable value a point, equal for equal positions."""
    rows = np.ascontiguousarray(points + 0.0)  # -0 and 0 are the same place
    return rows.view(np.dtype((np.void, rows.dtype.itemsize * 3))).ravel()


def find_unit(path: Path | str, scan: Scan, metres_per_unit: float | None) -> float:
    """Metres per unit of a file: what was said, or what its size tells for certain.

    Args:
        path: The file, to name it.
        scan: What was read of it, in its own unit.
        metres_per_unit: What was said; None when nobody did.

    Raises:
        ScanError: It makes no hand, or nobody said it and the size leaves it open.
    """
    size = float(measure_size(scan.points)[0])
    if metres_per_unit is not None:
        if not (np.isfinite(metres_per_unit) and metres_per_unit > 0.0):
            raise ScanError(path, f"a unit of {metres_per_unit} m", "a positive number of metres")
        if fault := find_size_fault(size * metres_per_unit, LONGEST_SCENE):
            raise ScanError(
                path,
                f"a scan that {fault} with 1 unit = {1e3 * metres_per_unit:.6g} mm",
                f"{SIZES_NEEDED}; correct its unit (metres per unit)",
            )
        return metres_per_unit
    if is_certain(size):
        return next(iter(find_possible_units(size).values()))
    found = (
        f"a size of {size:.4g} units (longest side), which is not a hand in metres, millimetres, centimetres or inches"
    )
    if possible := find_possible_units(size):
        lengths = " or ".join(f"{write_length(size * metres)} (1 unit = 1 {name})" for name, metres in possible.items())
        found = f"a size of {size:.4g} units (longest side), which may be {lengths} or something else"
    raise ScanError(path, found, f"its unit (metres per unit) that makes {SIZES_NEEDED}")

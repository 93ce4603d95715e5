"""Arrays in an .npz archive from anywhere: read without pickle, and never more than the archive says and we allow."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.errors import FileError, ModelFileError, reading
from tracker.model.file_limits import MAX_BYTES

MAX_MEMBERS = 64
"""Of an archive; a bound of ours."""
NEEDED = "an .npz archive of arrays"

KINDS = {"float": np.dtype("<f8"), "integer": np.dtype("<i8")}


def read_npz_arrays(path: Path) -> dict[str, npt.NDArray]:
    """All arrays of an .npz file: float64, int64 or text.

    Raises:
        ModelFileError: Not an archive of such arrays, damaged, or too large.
    """
    return _read_archive(path, _read_member, ModelFileError)


def list_npz_arrays(path: Path) -> set[str]:
    """Names of the arrays of an .npz file; none where it is no archive."""
    try:
        with reading(ModelFileError, path, NEEDED), zipfile.ZipFile(path) as archive:
            return {member.filename.removesuffix(".npy") for member in archive.infolist()[:MAX_MEMBERS]}
    except ModelFileError:
        return set()


def read_foreign_npz(path: Path, error: type[FileError] = ModelFileError) -> dict[str, npt.NDArray]:
    """All arrays of numbers and texts of another program's .npz file; pickled objects in it are left out, unread.

    Args:
        path: The file.
        error: What is raised where it is no archive of arrays, damaged, or too large.
    """
    arrays = _read_archive(path, _read_foreign_member, error)
    return {name: array for name, array in arrays.items() if array.dtype.kind != "O"}


def _read_archive(
    path: Path, read_member: Callable[[zipfile.ZipFile, zipfile.ZipInfo], npt.NDArray], error: type[FileError]
) -> dict[str, npt.NDArray]:
    with reading(error, path, NEEDED), zipfile.ZipFile(path) as archive:
        members = archive.infolist()
        if len(members) > MAX_MEMBERS or sum(member.file_size for member in members) > MAX_BYTES:
            raise error(path, "an archive with too many or too large members", f"at most {MAX_BYTES} bytes")
        return {member.filename.removesuffix(".npy"): read_member(archive, member) for member in members}


def _read_member(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> npt.NDArray:
    with archive.open(member) as file:
        version = np.lib.format.read_magic(file)
        if version == (1, 0):
            shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
        elif version == (2, 0):
            shape, fortran, dtype = np.lib.format.read_array_header_2_0(file)
        else:
            raise ValueError(f"{member.filename} has the array format {version}")
        if fortran or not (dtype in KINDS.values() or dtype.kind == "U"):
            raise ValueError(f"{member.filename} holds {dtype}, not float64, int64 or text in C order")
        if any(not isinstance(length, int) or length < 0 for length in shape):
            raise ValueError(f"{member.filename} has the shape {shape}")
        expected = dtype.itemsize
        for length in shape:
            expected *= length
        if expected > MAX_BYTES:
            raise ValueError(f"{member.filename} claims {expected} bytes")
        data = file.read(expected + 1)
    if len(data) != expected:
        raise ValueError(f"{member.filename} holds {len(data)} bytes of data where its shape needs {expected}")
    return np.frombuffer(data, dtype=dtype).reshape(shape).copy()


def _read_foreign_member(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> npt.NDArray:
    """As `_read_member`, but of any kind of number and order; an empty object array where objects are pickled."""
    with archive.open(member) as file:
        version = np.lib.format.read_magic(file)
        if version not in ((1, 0), (2, 0)):
            raise ValueError(f"{member.filename} has the array format {version}")
        read_header = np.lib.format.read_array_header_1_0 if version[0] == 1 else np.lib.format.read_array_header_2_0
        shape, fortran, dtype = read_header(file)
        if dtype.kind not in "fiubUS":
            return np.zeros(0, dtype=object)
        expected = dtype.itemsize * math.prod(shape)
        if any(length < 0 for length in shape) or expected > MAX_BYTES:
            raise ValueError(f"{member.filename} claims the shape {shape}")
        data = file.read(expected + 1)
    if len(data) != expected:
        raise ValueError(f"{member.filename} holds {len(data)} bytes of data where its shape needs {expected}")
    return np.frombuffer(data, dtype=dtype).reshape(shape, order="F" if fortran else "C").copy()


class NpzFields:
    """Arrays of one file, taken out by name with their kind and shape checked.

    Args:
        path: The file.
        arrays: By name.
        error: What is raised where one is not as it should be.
    """

    def __init__(self, path: Path, arrays: dict[str, npt.NDArray], error: type[FileError] = ModelFileError) -> None:
        self.path, self.arrays, self.error = path, arrays, error

    def __contains__(self, name: str) -> bool:
        return name in self.arrays

    def floats(self, name: str, shape: tuple[int, ...], limit: float) -> npt.NDArray[np.float64]:
        """float64 of this shape (-1: any length), finite and within ±limit."""
        return self._bound(name, self.take(name, KINDS["float"], shape), limit)

    def numbers(self, name: str, shape: tuple[int, ...], limit: float) -> npt.NDArray[np.float64]:
        """The same of whatever kind of numbers."""
        array = self.take(name, None, shape)
        return self._bound(name, np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape), limit)

    def text(self, name: str, longest: int = 500) -> str:
        """A single text, as another program wrote it."""
        array = self.arrays.get(name)
        if array is None or array.ndim or array.dtype.kind not in "US" or array.itemsize > 4 * longest:
            raise self.error(self.path, self._describe(name), f"'{name}', a text of at most {longest} letters")
        told = array.item()
        return told.decode("ascii", "replace") if isinstance(told, bytes) else str(told)

    def integers(self, name: str, shape: tuple[int, ...], low: int, high: int) -> npt.NDArray[np.int64]:
        """int64 of this shape (-1: any length), low <= value < high."""
        array = self.take(name, KINDS["integer"], shape)
        if array.size and (array.min() < low or array.max() >= high):
            raise self.error(
                self.path, f"'{name}' from {array.min()} to {array.max()}", f"values from {low} to {high - 1}"
            )
        return array

    def texts(self, name: str, count: int) -> tuple[str, ...]:
        """Text array of this length (-1: any)."""
        array = self.arrays.get(name)
        if array is None or array.dtype.kind != "U" or array.ndim != 1 or count not in (-1, len(array)):
            raise self.error(self.path, self._describe(name), f"'{name}', {'' if count < 0 else count} texts")
        return tuple(str(text) for text in array)

    def _bound(self, name: str, array: npt.NDArray, limit: float) -> npt.NDArray:
        if array.size and not (np.all(np.isfinite(array)) and np.abs(array).max() <= limit):
            raise self.error(self.path, f"'{name}' with values that are infinite or beyond {limit:g}", "sound numbers")
        return array

    def take(self, name: str, dtype: np.dtype | None, shape: tuple[int, ...]) -> npt.NDArray:
        """An array of this dtype, or of any kind of numbers where that is None, and shape (-1: any length)."""
        array = self.arrays.get(name)
        fits = (
            array is not None
            and (array.dtype == dtype if dtype else array.dtype.kind in "fiu")
            and array.ndim == len(shape)
            and all(want in (-1, have) for want, have in zip(shape, array.shape, strict=True))
        )
        if not fits or array is None:
            wanted = "x".join("N" if length < 0 else str(length) for length in shape)
            raise self.error(self.path, self._describe(name), f"'{name}', {dtype or 'numbers'} {wanted}")
        return array

    def _describe(self, name: str) -> str:
        array = self.arrays.get(name)
        return f"no '{name}'" if array is None else f"'{name}', {array.dtype} {'x'.join(map(str, array.shape))}"

"""Pickles of MANO and SMPL-H, read without running anything of them.

A pickle is a program: loading one calls whatever it names. This reader knows the few names that model files use, gives
inert records in their place, and turns what comes out into arrays by itself; NumPy, SciPy and chumpy are never called.
chumpy, whose objects the published files hold, is not needed and could not be installed (references in
docs/hand_models.md). Everything else that a pickle asks for is refused by its name.
"""
# pyright: reportAttributeAccessIssue=false, reportArgumentType=false
# The parts of pickle._Unpickler that are overridden here are not in its types.

from __future__ import annotations

import io
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import sparse

from tracker.errors import ModelFileError, reading

MAX_FILE_BYTES = 512 * 2**20
"""A bound of ours."""
NEEDED = "a pickled dictionary of NumPy arrays, SciPy sparse matrices and chumpy objects, as MANO's and SMPL-H's files"
KINDS = "fiub"
"""Numbers an array may hold."""
MAX_LINKS = 8
"""chumpy objects that stand one behind another."""


class PickleRefusedError(Exception):
    """A pickle asks for something that no model file needs."""


class Record:
    """What stands in for an object of a pickle: the name of its class, how it was made, its state."""

    def __init__(self, kind: str, arguments: tuple = ()) -> None:
        self.kind = kind
        self.arguments = arguments
        self.state: Any = None

    def __setstate__(self, state: Any) -> None:
        self.state = state


def read_restricted_pickle(path: Path) -> dict[str, Any]:
    """The dictionary of a model file: numbers and texts as they are, arrays and sparse matrices as their own kind.

    Objects of other kinds are left out: a file may hold what a model does not need.

    Raises:
        ModelFileError: No such dictionary, too large, or a pickle that asks for more than data.
    """
    path = Path(path)
    size = path.stat().st_size
    if size > MAX_FILE_BYTES:
        raise ModelFileError(path, f"{size} bytes", f"at most {MAX_FILE_BYTES}")
    with reading(ModelFileError, path, NEEDED):
        try:
            loaded = _Reader(io.BytesIO(path.read_bytes())).load()
        except PickleRefusedError as error:
            raise ModelFileError(path, f"a pickle that asks for {error}, which was not run", NEEDED) from error
    if not isinstance(loaded, dict):
        raise ModelFileError(path, f"a pickled {_kind_of(loaded)}", NEEDED)
    found = {}
    for key, value in loaded.items():
        if isinstance(key, bytes):
            key = key.decode("latin1")
        with reading(ModelFileError, f"{path}: '{str(key)[:60]}'", NEEDED):
            found[str(key)] = _resolve(value)
    return found


def _known(module: str, name: str) -> bool:
    """Whether model files name this."""
    top = module.split(".")[0]
    if top == "chumpy":
        return name.isidentifier()
    if top == "numpy":
        return name in ("ndarray", "dtype", "_reconstruct", "scalar", "_frombuffer")
    if top == "scipy":
        return module.startswith("scipy.sparse") and name in SPARSE
    return (module, name) in OTHERS


SPARSE = ("csc_matrix", "csr_matrix", "coo_matrix", "csc_array", "csr_array", "coo_array")
OTHERS = {
    ("_codecs", "encode"),
    ("copy_reg", "_reconstructor"),
    ("copyreg", "_reconstructor"),
    ("__builtin__", "object"),
    ("builtins", "object"),
    ("__builtin__", "bytes"),
    ("builtins", "bytes"),
}


class _Reader(pickle._Unpickler):
    """The pickle machine with another `find_class`, and without the opcodes that reach out of the file.

    It is the one written in Python: that in C makes room for as many memo entries as a hostile file claims.
    """

    dispatch = {  # noqa: RUF012
        code: run
        for code, run in pickle._Unpickler.dispatch.items()
        if bytes([code])
        not in (
            *(pickle.INST, pickle.OBJ, pickle.NEWOBJ_EX, pickle.PERSID, pickle.BINPERSID),
            *(pickle.EXT1, pickle.EXT2, pickle.EXT4, pickle.NEXT_BUFFER, pickle.READONLY_BUFFER),
        )
    }

    def __init__(self, file: io.BytesIO) -> None:
        super().__init__(file, encoding="latin1")

    def find_class(self, module: str, name: str) -> Any:
        if not _known(module, name):
            raise PickleRefusedError(f"{module[:60]}.{name[:60]}")
        return _Maker(name)

    def load_bytearray8(self) -> None:
        length = int.from_bytes(self.read(8), "little")
        self.append(bytes(self.read(length)))

    dispatch[pickle.BYTEARRAY8[0]] = load_bytearray8

    def load_newobj(self) -> None:
        arguments = self.stack.pop()
        self.stack[-1] = _call(self.stack[-1], arguments)

    dispatch[pickle.NEWOBJ[0]] = load_newobj

    def load_reduce(self) -> None:
        arguments = self.stack.pop()
        self.stack[-1] = _call(self.stack[-1], arguments)

    dispatch[pickle.REDUCE[0]] = load_reduce

    def load_build(self) -> None:
        state = self.stack.pop()
        if not isinstance(self.stack[-1], Record):
            raise PickleRefusedError(f"a state of a {_kind_of(self.stack[-1])}")
        self.stack[-1].state = state

    dispatch[pickle.BUILD[0]] = load_build


class _Maker:
    """A name of a pickle that may be called; it makes a record and nothing else."""

    def __init__(self, kind: str) -> None:
        self.kind = kind


def _call(maker: Any, arguments: Any) -> Any:
    if not isinstance(maker, _Maker) or not isinstance(arguments, tuple):
        raise PickleRefusedError(f"a call of a {_kind_of(maker)}")
    if maker.kind == "encode":  # Python 3 writes bytes for Python 2 as text and its encoding
        if len(arguments) != 2 or not isinstance(arguments[0], str) or arguments[1] != "latin1":
            raise PickleRefusedError("an encoding that is not latin1")
        return arguments[0].encode("latin1")
    if maker.kind == "bytes" and not arguments:  # so it writes none
        return b""
    if maker.kind in ("_reconstruct", "_reconstructor"):
        if not arguments or not isinstance(arguments[0], _Maker):
            raise PickleRefusedError("an object of no class")
        return Record(arguments[0].kind)
    return Record(maker.kind, arguments)


def _resolve(value: Any, links: int = 0) -> Any:
    """A record as an array or sparse matrix; None for what is neither."""
    if not isinstance(value, Record):
        return value if isinstance(value, (str, bytes, int, float, list, tuple)) else None
    if links > MAX_LINKS:
        raise ValueError("objects that are nested too deeply")
    if value.kind == "ndarray":
        version_and = value.state
        shape, dtype, is_fortran, raw = version_and[-4:]
        return _array(shape, dtype, bool(is_fortran), raw)
    if value.kind == "_frombuffer":
        raw, dtype, shape, order = value.arguments
        return _array(shape, dtype, order == "F", raw)
    if value.kind == "scalar":
        return _array((), value.arguments[0], False, value.arguments[1])
    if value.kind in SPARSE:
        return _sparse(value.kind, value.state)
    if isinstance(value.state, dict):
        return _chumpy(value.state, links)
    return None


def _array(shape: Any, dtype: Any, is_fortran: bool, raw: Any) -> npt.NDArray | None:
    if not isinstance(dtype, Record) or not isinstance(shape, tuple):
        raise ValueError("an array without shape or type")
    kind = _number_type(dtype)
    if kind is None:
        return None
    if isinstance(raw, str):
        raw = raw.encode("latin1")
    if not all(isinstance(length, int) and length >= 0 for length in shape):
        raise ValueError(f"the shape {shape}")
    if not isinstance(raw, (bytes, bytearray)) or math.prod(shape) * kind.itemsize != len(raw):
        raise ValueError(f"data that do not fill the shape {shape}")
    flat = np.frombuffer(raw, dtype=kind).astype(kind.newbyteorder("="))
    return flat.reshape(shape, order="F" if is_fortran else "C")


def _number_type(dtype: Record) -> np.dtype | None:
    """The type of numbers that a pickled dtype stands for; None for what is no number."""
    code = dtype.arguments[0]
    if not isinstance(code, str) or len(code) not in (2, 3) or code[0] not in KINDS:
        return None
    order = dtype.state[1] if isinstance(dtype.state, tuple) and len(dtype.state) > 1 else "|"
    return np.dtype(f"{order if order in ('<', '>') else '='}{code[0]}{int(code[1:])}")


def _sparse(kind: str, state: Any) -> sparse.csr_array:
    parts = {str(key): value for key, value in state.items()}
    rows, columns = (int(length) for length in parts["_shape" if "_shape" in parts else "shape"])
    data = np.asarray(_resolve(parts["data"]), dtype=np.float64)
    if kind.startswith("coo"):
        i, j = _coordinates(parts)
    elif kind.startswith("csr"):
        i, j = _compressed_places(parts, rows)
    else:
        j, i = _compressed_places(parts, columns)
    i, j = np.asarray(i, dtype=np.int64), np.asarray(j, dtype=np.int64)
    if not (i.shape == j.shape == data.shape and data.ndim == 1):
        raise ValueError("a sparse matrix of unequal parts")
    if len(i) and (min(i.min(), j.min()) < 0 or i.max() >= rows or j.max() >= columns):
        raise ValueError("a sparse matrix with places outside it")
    return sparse.csr_array((data, (i, j)), shape=(rows, columns))


def _coordinates(parts: dict[str, Any]) -> tuple[Any, Any]:
    """Rows and columns of a COO matrix, which older and newer SciPy keep under other names."""
    if "row" in parts:
        return _resolve(parts["row"]), _resolve(parts["col"])
    return _resolve(parts["coords"][0]), _resolve(parts["coords"][1])


def _compressed_places(parts: dict[str, Any], major: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """The major and the minor place of every value: row and column of CSR, column and row of CSC."""
    minor = np.asarray(_resolve(parts["indices"]), dtype=np.int64)
    starts = np.asarray(_resolve(parts["indptr"]), dtype=np.int64)
    if starts.shape != (major + 1,) or starts[0] != 0 or np.any(np.diff(starts) < 0) or starts[-1] != len(minor):
        raise ValueError("a sparse matrix whose rows do not add up")
    return np.repeat(np.arange(major), np.diff(starts)), minor


def _chumpy(state: dict, links: int) -> npt.NDArray | None:
    """A chumpy constant's array, or the elements that a chumpy selection picks out of another object."""
    if "idxs" in state and "a" in state:
        whole, places = _resolve(state["a"], links + 1), np.asarray(_resolve(state["idxs"]))
        if whole is None:
            return None
        picked = np.asarray(whole).ravel()[places.ravel().astype(np.int64)]
        shape = state.get("preferred_shape")
        return picked if shape is None else picked.reshape(tuple(int(length) for length in shape))
    return _resolve(state["x"], links + 1) if "x" in state else None


def _kind_of(value: Any) -> str:
    return value.kind if isinstance(value, (Record, _Maker)) else type(value).__name__

"""JSON from outside, read value by value, each with the place where it stands."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from tracker.errors import TrackerError, reading

Array = npt.NDArray[np.float64]


def read_regular_file(path: Path, max_bytes: int, error: type[TrackerError]) -> bytes:
    """Bytes of a plain file of at most max_bytes; a missing file, a folder, a pipe or a device is an error."""
    try:
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0))
    except FileNotFoundError:
        raise error(f"{path}: there is no such file.") from None
    except (OSError, ValueError) as cause:
        raise error(f"{path}: cannot be opened ({getattr(cause, 'strerror', None) or cause}).") from None
    try:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            raise error(f"{path}: is not a plain file.")
        if status.st_size > max_bytes:
            raise error(f"{path}: has {status.st_size} bytes; at most {max_bytes} are read.")
        with os.fdopen(descriptor, "rb", closefd=False) as file:  # which refuses a folder by itself
            return file.read(max_bytes)
    except OSError as cause:
        raise error(f"{path}: cannot be read ({cause.strerror}).") from None
    finally:
        os.close(descriptor)


@dataclass(frozen=True)
class Node:
    """One JSON value.

    Attributes:
        value: What `json` made of it.
        file: The file, for messages.
        where: Its place in the file, such as `cameras[0].K`.
        error: The error to raise.
    """

    value: Any
    file: str
    where: str
    error: type[TrackerError]

    def fail(self, needed: str) -> NoReturn:
        """Raise the error of this document: where, what was found, what is needed."""
        found = repr(self.value)
        found = found if len(found) <= 80 else found[:77] + "..."
        raise self.error(f"{self.file}: {self.where or 'the document'} is {found}; needed {needed}.")

    def members(self) -> list[str]:
        """Names of an object's members."""
        if not isinstance(self.value, dict):
            self.fail("an object {...}")
        return list(self.value)

    def has(self, key: str) -> bool:
        """Whether the object has this member, with a value other than null."""
        return key in self.members() and self.value[key] is not None

    def get(self, key: str) -> Node:
        """Member of an object; it must be there."""
        if key not in self.members():
            raise self.error(f"{self.file}: {self.where or 'the document'} has no {key!r}.")
        return Node(self.value[key], self.file, f"{self.where}.{key}" if self.where else key, self.error)

    def items(self, most: int) -> Iterator[Node]:
        """Elements of a list of at most `most`."""
        if not isinstance(self.value, list):
            self.fail("a list [...]")
        if len(self.value) > most:
            raise self.error(f"{self.file}: {self.where} has {len(self.value)} elements; at most {most} are read.")
        for i, value in enumerate(self.value):
            yield Node(value, self.file, f"{self.where}[{i}]", self.error)

    def text(self, most: int = 200) -> str:
        """A text of 1 to `most` printable characters."""
        value = self.value
        if not isinstance(value, str) or not value.strip() or len(value) > most or not value.isprintable():
            self.fail(f"a text of 1 to {most} printable characters")
        return value

    def choice(self, *allowed: str) -> str:
        """One of the given texts."""
        if not isinstance(self.value, str) or self.value not in allowed:
            self.fail("one of " + ", ".join(allowed))
        return self.value

    def integer(self, low: int, high: int) -> int:
        """A whole number in [low, high]."""
        if isinstance(self.value, bool) or not isinstance(self.value, int) or not low <= self.value <= high:
            self.fail(f"a whole number from {low} to {high}")
        return self.value

    def number(self, low: float, high: float) -> float:
        """A finite number in [low, high]."""
        value = self.value
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not low <= value <= high:  # NaN is in no interval.
            self.fail(f"a number from {low:g} to {high:g}")
        return float(value)

    def vector(self, most: int, bound: float = 1e9) -> Array:
        """A list of at most `most` finite numbers, as (n,)."""
        return np.array([item.number(-bound, bound) for item in self.items(most)], dtype=np.float64)

    def matrix(self, rows: int, columns: int, bound: float = 1e9) -> Array:
        """A list of rows of finite numbers, as (rows, columns)."""
        result = [row.vector(columns, bound) for row in self.items(rows)]
        if len(result) != rows or any(len(row) != columns for row in result):
            self.fail(f"{rows} rows of {columns} numbers")
        return np.stack(result)


def parse_json(data: bytes, file: str, error: type[TrackerError]) -> Node:
    """Strict JSON: UTF-8, no NaN or Infinity, no endless nesting."""

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"it holds {constant}, which is not a number")

    with reading(error, file, "valid JSON in UTF-8"):
        return Node(json.loads(data.decode("utf-8-sig"), parse_constant=refuse), file, "", error)


def load_json(path: Path, max_bytes: int, error: type[TrackerError]) -> Node:
    """Read and parse a JSON file of at most max_bytes."""
    return parse_json(read_regular_file(path, max_bytes, error), str(path), error)

"""Errors of the tracker: bad input from outside, said with the facts.

A broken promise between two of our own functions is an `assert`, never one of these.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar


def say_count(count: int, one: str, many: str | None = None) -> str:
    """`1 file`, `2 files`: a number with the words that fit it."""
    return f"{count} {one if count == 1 else many or one + 's'}"


class TrackerError(Exception):
    """Base of every error that bad input can cause."""


class FileError(TrackerError):
    """A file from outside is not usable.

    Args:
        path: The file.
        found: What was found in it.
        needed: What a file of this kind must have.
    """

    def __init__(self, path: Path | str, found: str, needed: str) -> None:
        self.path = str(path)
        self.found = found
        self.needed = needed
        super().__init__(f"{path}: found {found}; needed {needed}.")


class FrameError(TrackerError):
    """A frame cannot be read or used."""


class SequenceError(TrackerError):
    """A recording folder or one of the files that describe it is not usable."""


class CalibrationError(TrackerError):
    """A camera calibration is missing or impossible."""


class ImportRefusedError(TrackerError):
    """A recording was refused before anything of it was stored."""


class AnnotationError(TrackerError):
    """An annotation file or item is not usable.

    Args:
        message: What came, what is needed, what to do.
        details: What else was found, for those who want to know.
    """

    def __init__(self, message: str, details: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.details = details


class ModelFileError(FileError):
    """A hand or object model file is not usable."""


class ScanError(FileError):
    """A scan file is not usable."""


class RegistrationError(FileError):
    """A registration's file is not usable."""


class SolveError(TrackerError):
    """An objective cannot be minimised."""


class TrackingError(TrackerError):
    """A recording cannot be tracked as asked."""


class TrainingError(TrackerError):
    """Registrations cannot be learnt from."""


@contextmanager
def reading(error: type[TrackerError], path: Path | str, needed: str) -> Iterator[None]:
    """The one guard of all readers of foreign files: whatever a parser throws becomes the reader's own error.

    Parsers throw more than they say: of a garbled file NumPy's raises `tokenize.TokenError`, a size that a file claims
    is a `MemoryError`, nesting without end a `RecursionError`.

    Args:
        error: What a reader raises; a reader's own words come through as they are.
        path: The file.
        needed: What such a file must be.
    """
    try:
        yield
    except TrackerError:
        raise
    except Exception as fault:  # of every kind: the file is to blame, whatever its parser trips over
        if isinstance(fault, OSError) and fault.strerror:
            found = f"a file that cannot be read ({fault.strerror})"
        else:
            found = f"a damaged file ({type(fault).__name__}: {str(fault)[:120]})"
        if issubclass(error, FileError):
            raise error(path, found, needed) from fault
        raise error(f"{path}: found {found}; needed {needed}.") from fault


Read = TypeVar("Read")


def reads(error: type[TrackerError], needed: str) -> Callable[[Callable[..., Read]], Callable[..., Read]]:
    """`reading` around a whole reader whose first argument is the file."""

    def guard(reader: Callable[..., Read]) -> Callable[..., Read]:
        @wraps(reader)
        def guarded(path: Path | str, *args: Any, **options: Any) -> Read:
            with reading(error, path, needed):
                return reader(path, *args, **options)

        return guarded

    return guard

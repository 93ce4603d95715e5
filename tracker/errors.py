"""Errors of the tracker: bad input from outside, said with the facts.

A broken promise between two of our own functions is an `assert`, never one of these.
"""

from __future__ import annotations

from pathlib import Path


def say_count(count: int, one: str, many: str | None = None) -> str:
    """`1 file`, `2 files`: a number with the words that fit it."""
    return f"{count} {one if count == 1 else many or one + 's'}"


class TrackerError(Exception):
    """Base of every error that bad input can cause."""


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


class ModelFileError(TrackerError):
    """A hand or object model file is not usable.

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


class ScanError(TrackerError):
    """A scan file is not usable.

    Args:
        path: The file.
        found: What was found in it.
        needed: What a scan must have.
    """

    def __init__(self, path: Path | str, found: str, needed: str) -> None:
        self.path = str(path)
        self.found = found
        self.needed = needed
        super().__init__(f"{path}: found {found}; needed {needed}.")


class RegistrationError(TrackerError):
    """A registration's file is not usable.

    Args:
        path: The file.
        found: What was found in it.
        needed: What such a file must have.
    """

    def __init__(self, path: Path | str, found: str, needed: str) -> None:
        self.path = str(path)
        self.found = found
        self.needed = needed
        super().__init__(f"{path}: found {found}; needed {needed}.")


class SolveError(TrackerError):
    """An objective cannot be minimised."""


class TrackingError(TrackerError):
    """A recording cannot be tracked as asked."""


class TrainingError(TrackerError):
    """Registrations cannot be learnt from."""

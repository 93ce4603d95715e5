"""A fingertip detector that a lab has trained, and which file it came from."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from tracker.detection.forest import Forest
from tracker.detection.forest_files import load_forest


@dataclass(frozen=True)
class OwnDetector:
    """What `handloom train-detector` wrote, given to a run in place of the bundled detector.

    Attributes:
        forest: Finds fingertips.
        name: Of the file, or as somebody named it.
        sha256: Of the file, hexadecimal.
    """

    forest: Forest
    name: str
    sha256: str

    def to_json(self) -> dict[str, str]:
        """What a track tells of it."""
        return {"name": self.name, "sha256": self.sha256}


def load_detector(path: Path, name: str | None = None) -> OwnDetector:
    """A detector from a file; without a name it has the file's.

    Raises:
        ModelFileError: It is no detector, or a damaged one.
    """
    path = Path(path)
    forest = load_forest(path)
    return OwnDetector(forest, name or path.name, hashlib.sha256(path.read_bytes()).hexdigest())

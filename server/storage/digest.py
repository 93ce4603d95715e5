"""The hash by which files are held against what they should be."""

from __future__ import annotations

import hashlib
from pathlib import Path


def compute_digest(path: Path) -> str:
    """SHA-256 of a file, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()

"""A recording's files in one short text."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from tracker import Sequence

_EDITABLE = ("name", "hands", "annotations")


def compute_content_key(recording: Sequence) -> str:
    """32 hexadecimal digits that change with any file of the recording, but not with what people may edit of it."""
    digest = hashlib.sha256()
    document: dict[str, Any] = {k: v for k, v in recording.to_json().items() if k not in _EDITABLE}
    digest.update(json.dumps(document, sort_keys=True).encode())
    edited = {"sequence.json", recording.annotations}
    for path in sorted(path for path in recording.folder.rglob("*") if path.is_file()):
        name = path.relative_to(recording.folder).as_posix()
        if name not in edited:
            digest.update(f"\0{name}\0".encode() + _digest_file(path))
    return digest.hexdigest()[:32]


def _digest_file(path: Path) -> bytes:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").digest()

"""The working files of a job: written whole or not at all, and checked before they are read again.

Layout of `jobs/<id>/`: `annotations.json` as they were when the job began, `setup/`, `state-0000.npz` before the first
chunk, `state-0001.npz` and `chunk-0000.npz` after it, and so on. A step's manifest `<step>.json` is written last and
names the SHA-256 of each file of that step: a step whose manifest holds is done and need not be done again.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Any

from server.errors import StudioError


class DamagedFileError(StudioError):
    """A working file is missing or is not what the job wrote."""

    status_code = 500


class JobFiles:
    """Paths, manifests and atomic writes below one job's folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def annotations(self) -> Path:
        return self.folder / "annotations.json"

    @property
    def setup(self) -> Path:
        return self.folder / "setup"

    def state(self, chunk: int) -> Path:
        """State of the tracker before `chunk`."""
        return self.folder / f"state-{chunk:04d}.npz"

    def chunk(self, chunk: int) -> Path:
        return self.folder / f"chunk-{chunk:04d}.npz"

    def read_manifest(self, step: str) -> dict[str, Any] | None:
        """What `step` returned, or None when it was not finished or a file of it has changed."""
        try:
            manifest = json.loads((self.folder / f"{step}.json").read_text())
            self.check(manifest["files"])
        except (OSError, ValueError, KeyError, DamagedFileError):
            return None
        return manifest

    def write_manifest(self, step: str, paths: list[Path], facts: dict[str, Any]) -> dict[str, Any]:
        """Seal `step` with the digests of its files."""
        manifest = {"files": {str(path.relative_to(self.folder)): digest(path) for path in paths}, **facts}
        self.write(self.folder / f"{step}.json", lambda path: path.write_text(json.dumps(manifest, indent=1)))
        return manifest

    def check(self, digests: dict[str, str]) -> None:
        """Raise unless every file is there with the digest given."""
        for name, expected in digests.items():
            path = self.folder / name
            found = digest(path) if path.exists() else "nothing"
            if found != expected:
                raise DamagedFileError(
                    f"The job's file {name} is damaged: found SHA-256 {found[:12]}, needed {expected[:12]}. "
                    "Retry the job: it starts from the recording again."
                )

    def write(self, path: Path, save: Callable[[Path], Any]) -> None:
        """Call `save` with a temporary sibling (same suffix), make it durable, then give it its name."""
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_name(f".{uuid.uuid4().hex}-{path.name}")
        try:
            save(temporary)
            sync(temporary)
            if path.is_dir():
                shutil.rmtree(path)
            os.replace(temporary, path)
            sync(path.parent)
        finally:
            if temporary.is_dir():
                shutil.rmtree(temporary, ignore_errors=True)
            else:
                temporary.unlink(missing_ok=True)

    def remove(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)


def digest(path: Path) -> str:
    """SHA-256 of a file, or of a folder's relative names and contents."""
    result = hashlib.sha256()
    if path.is_dir():
        for file in sorted(p for p in path.rglob("*") if p.is_file()):
            result.update(str(file.relative_to(path)).encode() + b"\0" + file.read_bytes())
    else:
        result.update(path.read_bytes())
    return result.hexdigest()


def sync(path: Path) -> None:
    """Have the disk hold a file, or a folder with all below it."""
    if path.is_dir():
        for child in path.rglob("*"):
            if child.is_file():
                _sync_one(child)
    _sync_one(path)


def _sync_one(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

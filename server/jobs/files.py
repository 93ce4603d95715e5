"""The working files of a job: written whole or not at all, and checked before they are read again.

Layout of `jobs/<id>/`: `annotations.json` as they were when the job began, `setup/`, `state-0000.npz` before the first
chunk, `state-0001.npz` and `chunk-0000.npz` after it, and so on; of training `train-0-round-1.npz` and the like. A
step's manifest `<step>.json` is written last and
names the SHA-256 of each file of that step: a step whose manifest holds is done and need not be done again. With a
store behind the data folder, files and manifests go there too, so that another machine can go on.
"""

from __future__ import annotations

import json
import os
import shutil
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.errors import StudioError
from server.storage.digest import compute_digest

if TYPE_CHECKING:
    from server.storage.remote import RemoteFolder


class DamagedFileError(StudioError):
    """A working file is missing or is not what the job wrote."""

    status_code = 500


class JobFiles:
    """Paths, manifests and atomic writes below one job's folder."""

    def __init__(self, folder: Path, remote: RemoteFolder | None = None) -> None:
        self.folder, self._remote = folder, remote

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
            self._check_here(manifest["files"])
            return manifest
        except (OSError, ValueError, KeyError, DamagedFileError):
            return self._fetch_manifest(step)

    def is_done(self, step: str) -> bool:
        """Whether `step` was finished, here or on another machine; its files are not looked at."""
        if (self.folder / f"{step}.json").is_file():
            return True
        return self._remote is not None and self._remote.read_document(step) is not None

    def write_manifest(self, step: str, paths: list[Path], described: dict[str, Any]) -> dict[str, Any]:
        """Seal `step` with the digests of its files."""
        files = [file for path in paths for file in (sorted(path.rglob("*")) if path.is_dir() else [path])]
        digests = {file.relative_to(self.folder).as_posix(): compute_digest(file) for file in files if file.is_file()}
        manifest = {"files": digests, **described}
        if self._remote is not None:
            self._remote.put_blobs({digest: self.folder / name for name, digest in digests.items()})
        self.write(self.folder / f"{step}.json", lambda path: path.write_text(json.dumps(manifest, indent=1)))
        if self._remote is not None:
            self._remote.write_document(step, manifest)
        return manifest

    def check(self, digests: dict[str, str]) -> None:
        """Raise unless every file is there with the digest given; what another machine wrote is fetched."""
        if self._remote is not None:
            self._remote.get_blobs(
                (digest, self.folder / name)
                for name, digest in digests.items()
                if self._find_digest(self.folder / name) != digest
            )
        self._check_here(digests)

    def _fetch_manifest(self, step: str) -> dict[str, Any] | None:
        """What another machine did of `step`, with its files; None when none did."""
        manifest = None if self._remote is None else self._remote.read_document(step)
        if manifest is not None:
            self.check(manifest["files"])
            self.write(self.folder / f"{step}.json", lambda path: path.write_text(json.dumps(manifest, indent=1)))
        return manifest

    def _find_digest(self, path: Path) -> str:
        return compute_digest(path) if path.is_file() else "nothing"

    def _check_here(self, digests: dict[str, str]) -> None:
        for name, expected in digests.items():
            if (found := self._find_digest(self.folder / name)) != expected:
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
            _sync_one(path.parent)  # the name alone: what lies beside it is other writers' and may vanish
        finally:
            if temporary.is_dir():
                shutil.rmtree(temporary, ignore_errors=True)
            else:
                temporary.unlink(missing_ok=True)

    def remove(self) -> None:
        """Remove them, in the store too."""
        shutil.rmtree(self.folder, ignore_errors=True)
        if self._remote is not None:
            self._remote.remove("snapshot")


def sync(path: Path) -> None:
    """Have the disk hold a file, or a folder with all below it."""
    if path.is_dir():
        for child in path.rglob("*"):
            _sync_one(child)
    _sync_one(path)


def _sync_one(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

"""Storage of a studio on several machines: what is finished goes to a store that all reach, and comes from there.

The data folder of each machine is then a cache of the store. `.store/<area>/<id>.json` in it is the manifest of each
folder that is safe in the store; its time tells when the folder was last asked for.
"""

from __future__ import annotations

import json
import logging
import os
import shutil
import time
import uuid
from pathlib import Path
from typing import Any

from server.storage.digest import compute_digest
from server.storage.remote import RemoteFolder, RemoteStore
from server.storage.storage import Storage

log = logging.getLogger(__name__)

SHARED_AREAS = frozenset(
    {
        "sequences",
        "tracks",
        "snapshots",
        "scans",
        "registrations",
        "moving_scans",
        "moving_registrations",
        "frame_registrations",
        "models",
        "training_sets",
        "detectors",
        "films",
        "calibrations",
    }
)
"""Whose folders are finished when they are published. Jobs keep their working files in the store step by step."""

MANIFEST = "manifest"
DOCUMENT = "document"
IDLE_SECONDS = 3600.0
"""A folder asked for more recently than this is never dropped from this machine: somebody may be reading it."""

FETCH_PREFIX = ".fetched-"


class SharedStorage(Storage):
    """Local folders, backed by a store.

    Args:
        root: The data folder.
        store: Where finished folders are kept for all machines.
        cache_bytes: How much of what is safe in the store may stay on this machine.
    """

    def __init__(self, root: Path, store: RemoteStore, cache_bytes: int) -> None:
        super().__init__(root)
        self._store, self._cache_bytes = store, cache_bytes

    def folder(self, area: str, id_: uuid.UUID) -> Path:
        """Folder of one thing, fetched when it is in the store only."""
        folder = super().folder(area, id_)
        if area not in SHARED_AREAS:
            return folder
        if not folder.exists():
            self._fetch(area, id_, folder)
        elif (note := self._note(area, id_)).exists():
            os.utime(note)
        return folder

    def refresh(self, area: str, id_: uuid.UUID) -> Path:
        """Folder of one thing as it is in the store now, where another machine may have changed it."""
        folder = self.folder(area, id_)
        manifest = self._store.folder(area, id_).read_document(MANIFEST)
        if manifest is None or manifest == self._read_note(area, id_):
            return folder
        self._store.folder(area, id_).get_blobs(
            (part["sha256"], folder / name)
            for name, part in manifest["files"].items()
            if not (folder / name).is_file() or compute_digest(folder / name) != part["sha256"]
        )
        self._write_note(area, id_, manifest)
        return folder

    def publish(self, area: str, id_: uuid.UUID) -> None:
        """Send a folder to the store: first its files, then the manifest by which others find it."""
        assert area in SHARED_AREAS, area
        folder, remote = super().folder(area, id_), self._store.folder(area, id_)
        known = (self._read_note(area, id_) or {"files": {}})["files"].values()
        sent = {part["sha256"] for part in known}
        files: dict[str, dict[str, Any]] = {}
        paths: dict[str, Path] = {}
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            digest = compute_digest(path)
            files[path.relative_to(folder).as_posix()] = {"sha256": digest, "bytes": path.stat().st_size}
            paths[digest] = path
        remote.put_blobs({digest: path for digest, path in paths.items() if digest not in sent})
        manifest = {"version": 1, "files": files}
        remote.write_document(MANIFEST, manifest)
        self._write_note(area, id_, manifest)

    def document(self, area: str, id_: uuid.UUID) -> Path:
        """File of a thing that is one document, fetched when it is in the store only."""
        path = super().document(area, id_)
        if not path.exists() and (described := self._store.folder(area, id_).read_document(DOCUMENT)) is not None:
            self._store.folder(area, id_).get_blobs([(described["sha256"], path)])
        return path

    def add_document(self, area: str, id_: uuid.UUID, data: bytes) -> None:
        """Write such a file here and in the store."""
        super().add_document(area, id_, data)
        path, remote = super().document(area, id_), self._store.folder(area, id_)
        digest = compute_digest(path)
        remote.put_blobs({digest: path})
        remote.write_document(DOCUMENT, {"version": 1, "sha256": digest, "bytes": len(data)})

    def remove(self, area: str, id_: uuid.UUID) -> None:
        """Remove it here and in the store."""
        super().remove(area, id_)
        if area in SHARED_AREAS:
            self._note(area, id_).unlink(missing_ok=True)
            self._store.folder(area, id_).remove(MANIFEST)

    def remove_document(self, area: str, id_: uuid.UUID) -> None:
        """Remove it here and in the store."""
        super().remove_document(area, id_)
        self._store.folder(area, id_).remove(DOCUMENT)

    def remote_folder(self, area: str, id_: uuid.UUID) -> RemoteFolder:
        return self._store.folder(area, id_)

    def evict(self) -> None:
        """Drop folders that are safe in the store, the longest unused first, until the rest is small enough."""
        found = []
        for note in (self.root / ".store").glob("*/*.json"):
            manifest = json.loads(note.read_text())
            size = sum(part["bytes"] for part in manifest["files"].values())
            found.append((note.stat().st_mtime, size, note.parent.name, uuid.UUID(note.stem)))
        too_much = sum(size for _, size, _, _ in found) - self._cache_bytes
        for asked_at, size, area, id_ in sorted(found):
            if too_much <= 0 or time.time() - asked_at < IDLE_SECONDS:
                break
            log.info("%s %s leaves this machine; the store has it", area, id_)
            self._note(area, id_).unlink(missing_ok=True)
            super().remove(area, id_)
            too_much -= size

    def _fetch(self, area: str, id_: uuid.UUID, folder: Path) -> None:
        """Bring a folder here whole, or leave it when the store has none."""
        remote = self._store.folder(area, id_)
        manifest = remote.read_document(MANIFEST)
        if manifest is None:
            return
        self._sweep_fetches(folder.parent)
        temporary = folder.with_name(f"{FETCH_PREFIX}{uuid.uuid4().hex}")
        temporary.mkdir()
        try:
            remote.get_blobs((part["sha256"], temporary / name) for name, part in manifest["files"].items())
            try:
                temporary.rename(folder)
            except OSError:
                if not folder.exists():
                    raise
                return  # another process of this machine was quicker
        finally:
            shutil.rmtree(temporary, ignore_errors=True)
        self._write_note(area, id_, manifest)
        self.evict()

    @staticmethod
    def _sweep_fetches(parent: Path) -> None:
        """Remove what processes left that died while they fetched."""
        for entry in parent.glob(f"{FETCH_PREFIX}*"):
            if time.time() - entry.stat().st_mtime > IDLE_SECONDS:
                shutil.rmtree(entry, ignore_errors=True)

    def _note(self, area: str, id_: uuid.UUID) -> Path:
        return self.root / ".store" / area / f"{id_}.json"

    def _read_note(self, area: str, id_: uuid.UUID) -> dict[str, Any] | None:
        try:
            return json.loads(self._note(area, id_).read_text())
        except FileNotFoundError:
            return None

    def _write_note(self, area: str, id_: uuid.UUID, manifest: dict[str, Any]) -> None:
        note = self._note(area, id_)
        note.parent.mkdir(parents=True, exist_ok=True)
        temporary = note.with_name(f".{uuid.uuid4().hex}")
        temporary.write_text(json.dumps(manifest))
        os.replace(temporary, note)

"""Folders and files below the data folder, named by the studio alone: `<area>/<uuid>/...`.

Nothing a client sends is ever part of a path here but a UUID that was parsed. The areas: `sequences` (recording
folders), `uploads`, and those of other rooms.
"""

from __future__ import annotations

import os
import shutil
import uuid
from pathlib import Path
from typing import Annotated, Any

import fsspec
from fastapi import Depends
from fsspec.implementations.dirfs import DirFileSystem
from starlette.requests import HTTPConnection


class Storage:
    """The studio's files: `fs` is the fsspec view of them, `folder` gives the tracker what it needs, local files."""

    def __init__(self, root: Path) -> None:
        self.root = root
        root.mkdir(parents=True, exist_ok=True)
        self.fs: Any = DirFileSystem(path=str(root), fs=fsspec.filesystem("file"))

    def folder(self, area: str, id_: uuid.UUID) -> Path:
        """Folder of one thing; it need not exist yet, but the area does."""
        assert area.isidentifier(), area
        parent = self.root / area
        parent.mkdir(exist_ok=True)
        return parent / str(id_)

    def move(self, source: Path, area: str, id_: uuid.UUID) -> Path:
        """Give a folder that lies in the storage its final place, whole and durable; the place must be free."""
        assert source.is_relative_to(self.root), source
        target = self.folder(area, id_)
        assert not target.exists(), target
        sync_tree(source)
        source.rename(target)
        _sync(target.parent)
        return target

    def remove(self, area: str, id_: uuid.UUID) -> None:
        """Remove the folder of one thing, which may be gone already. It loses its name first: no half of it is seen."""
        target = self.folder(area, id_)
        doomed = target.with_name(f".removed-{uuid.uuid4().hex}")
        try:
            target.rename(doomed)
        except FileNotFoundError:
            return
        shutil.rmtree(doomed, ignore_errors=True)

    def list_ids(self, area: str) -> list[uuid.UUID]:
        """Ids of the things that have a folder in an area, those being removed not."""
        found = []
        for entry in sorted((self.root / area).glob("*")):
            try:
                found.append(uuid.UUID(entry.name))
            except ValueError:
                continue
        return found

    def sweep(self, area: str) -> None:
        """Finish removals that were interrupted."""
        for entry in (self.root / area).glob(".removed-*"):
            shutil.rmtree(entry, ignore_errors=True)


def sync_tree(folder: Path) -> None:
    """Have the disk hold a folder with all below it."""
    for parent, _, names in os.walk(folder):
        for name in names:
            _sync(Path(parent, name))
        _sync(Path(parent))


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def get_storage(connection: HTTPConnection) -> Storage:
    """The app's storage."""
    return connection.app.state.storage


StorageDep = Annotated[Storage, Depends(get_storage)]

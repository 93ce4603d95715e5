"""Folders and files below the data folder, named by the studio alone: `<area>/<uuid>/...`.

Nothing a client sends is ever part of a path here but a UUID that was parsed. The areas: `sequences` (recording
folders), `uploads`, and those of other rooms.
"""

from __future__ import annotations

import os
import shutil
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

if TYPE_CHECKING:
    from server.settings import Settings
    from server.storage.remote import RemoteFolder


class Storage:
    """The studio's files. Two levels of names and nothing else, so that they can be keys of an object store too."""

    def __init__(self, root: Path) -> None:
        self.root = root
        root.mkdir(parents=True, exist_ok=True)

    def folder(self, area: str, id_: uuid.UUID) -> Path:
        """Folder of one thing; it need not exist yet, but the area does."""
        assert area.isidentifier(), area
        parent = self.root / area
        parent.mkdir(exist_ok=True)
        return parent / str(id_)

    def refresh(self, area: str, id_: uuid.UUID) -> Path:
        """Folder of one thing, with what other machines have changed in it. Here no other has its files."""
        return self.folder(area, id_)

    def publish(self, area: str, id_: uuid.UUID) -> None:
        """Say that the folder of one thing is whole: other machines may have it. Here there are none."""

    def remote_folder(self, area: str, id_: uuid.UUID) -> RemoteFolder | None:
        """Where working files of one thing are kept for other machines; None when there are none."""
        return None

    def document(self, area: str, id_: uuid.UUID) -> Path:
        """File `<area>/<id>.json` of a thing that is one document; it need not exist yet."""
        return Storage.folder(self, area, id_).with_suffix(".json")

    def add_document(self, area: str, id_: uuid.UUID, data: bytes) -> None:
        """Write such a file, whole and on the disk before this returns. One that is there is never written again."""
        path = Storage.document(self, area, id_)
        unfinished = path.with_name(f".unfinished-{uuid.uuid4().hex}")
        try:
            with unfinished.open("xb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.link(unfinished, path)
        finally:
            unfinished.unlink(missing_ok=True)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)

    def remove(self, area: str, id_: uuid.UUID) -> None:
        """Remove the folder of one thing, which may be gone already. It loses its name first: no half of it is seen."""
        target = self.folder(area, id_)
        doomed = target.with_name(f".removed-{uuid.uuid4().hex}")
        try:
            target.rename(doomed)
        except FileNotFoundError:
            return
        shutil.rmtree(doomed, ignore_errors=True)

    def remove_document(self, area: str, id_: uuid.UUID) -> None:
        """Remove the file of a thing that is one document, which may be gone already."""
        Storage.folder(self, area, id_).with_suffix(".json").unlink(missing_ok=True)

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


def open_storage(settings: Settings) -> Storage:
    """The storage that the settings ask for: this machine's data folder, with a store behind it when one is named."""
    if settings.store_url is None:
        return Storage(settings.data_dir)
    from server.storage.remote import RemoteStore  # loads the libraries of the store: not before somebody asks
    from server.storage.shared import SharedStorage

    store = RemoteStore(settings.store_url, settings.store_endpoint)
    return SharedStorage(settings.data_dir, store, int(settings.store_cache_gb * 1e9))


async def get_storage(connection: HTTPConnection) -> Storage:
    """The app's storage."""
    return connection.app.state.storage


StorageDep = Annotated[Storage, Depends(get_storage)]

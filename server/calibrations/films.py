"""The films of an upload: archives unpacked, then kept in a folder of their own below `films`."""

from __future__ import annotations

import uuid
from pathlib import Path

from server.errors import InvalidError
from server.storage import Storage
from server.storage.upload import Upload, UploadLimits
from tracker.capture import ArchiveLimits, extract_archive

AREA = "films"
UPLOADS = "film_uploads"
"""Where an upload lies until it has arrived whole."""


def keep_films(storage: Storage, folder: Path, upload: Upload, limits: UploadLimits) -> uuid.UUID:
    """Unpack the archives of an upload and move it, whole, to where films are kept; gives the folder's id."""
    source = _unpack(folder, upload, limits)
    films_id = uuid.uuid4()
    source.rename(storage.folder(AREA, films_id))
    storage.publish(AREA, films_id)
    return films_id


def find_films(storage: Storage, films_id: uuid.UUID) -> Path | None:
    """The folder of films; None when they were removed."""
    folder = storage.folder(AREA, films_id)
    return folder if folder.is_dir() else None


def _unpack(folder: Path, upload: Upload, limits: UploadLimits) -> Path:
    """An archive becomes a folder of its name; an upload that is one archive becomes what is in it."""
    archives = [name for name in upload.names if "/" not in name and name.lower().endswith(".zip")]
    left = ArchiveLimits(limits.files, limits.total_bytes)
    if archives == upload.names and len(archives) == 1:
        extract_archive(folder / archives[0], folder / ".whole", left)
        return folder / ".whole"
    for name in archives:
        inside = folder / Path(name).stem
        if inside.exists():
            raise InvalidError(f"{inside.name}: two cameras have this name; rename one of them. Nothing was kept.")
        unpacked = extract_archive(folder / name, inside, left)
        (folder / name).unlink()
        used = sum((inside / file).stat().st_size for file in unpacked)
        left = ArchiveLimits(left.files - len(unpacked), left.total_bytes - used)
    return folder

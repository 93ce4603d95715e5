"""A folder that is made beside its place and renamed into it when it is whole."""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import shutil
import uuid
from collections.abc import Iterator
from pathlib import Path

from tracker.capture.atomic_file import sync_folder

_LEFTOVER = re.compile(r"\..{1,200}\.unfinished-[0-9a-f]{32}", re.DOTALL)


@contextlib.contextmanager
def make_workplace(destination: Path) -> Iterator[Path]:
    """A folder to fill; it becomes the destination when the block ends well, and is removed when it does not.

    It is locked as long as its process lives, so that leftovers of a killed one can be told from work in progress.
    The destination may be an empty folder.
    """
    destination.parent.mkdir(parents=True, exist_ok=True)
    clean_leftovers(destination.parent)
    folder = destination.with_name(f".{destination.name[:150]}.unfinished-{uuid.uuid4().hex}")
    folder.mkdir(mode=0o755)
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield folder
        _sync_tree(folder)
        os.rename(folder, destination)
        sync_folder(destination.parent)
    finally:
        os.close(descriptor)
        shutil.rmtree(folder, ignore_errors=True)


def clean_leftovers(parent: Path | str) -> list[Path]:
    """Remove what killed imports left in a folder; imports that still run keep theirs."""
    removed = []
    for path in Path(parent).iterdir() if Path(parent).is_dir() else ():
        if not _LEFTOVER.fullmatch(path.name) or path.is_symlink() or not path.is_dir():
            continue
        with contextlib.suppress(OSError):
            descriptor = os.open(path, os.O_RDONLY)
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(path)
                removed.append(path)
            finally:
                os.close(descriptor)
    return removed


def _sync_tree(folder: Path) -> None:
    """Flush every file and name below a folder to the disk."""
    for parent, _, files in os.walk(folder, topdown=False):
        for name in files:
            descriptor = os.open(Path(parent) / name, os.O_RDONLY)
            try:
                os.fsync(descriptor)
            finally:
                os.close(descriptor)
        sync_folder(Path(parent))

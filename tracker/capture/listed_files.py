"""The files of a folder that somebody wants to import."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tracker.capture.relative_path import find_path_fault, is_inside
from tracker.errors import ImportRefusedError

MAX_FILES = 4_000_000
"""In a folder; a bound of ours."""
MAX_DEPTH = 12
"""Folders in folders; a bound of ours."""


@dataclass(frozen=True)
class ListedFiles:
    """A folder and the plain files below it.

    Attributes:
        root: The folder that the recording begins in.
        names: Relative names with `/`, sorted; hidden files and file managers' clutter left out.
        refused: Names that were left out because they are links out of the folder or no plain files, with the reason.
    """

    root: Path
    names: tuple[str, ...]
    refused: tuple[str, ...] = ()

    def path(self, name: str) -> Path:
        """Full path of a listed file."""
        return self.root / name


def list_files(source: Path) -> ListedFiles:
    """List a folder, beginning at the only folder in it as long as there is nothing else (as in most archives)."""
    if not source.exists():
        raise ImportRefusedError(f"{source}: there is no such file or folder.")
    if source.is_file():
        return ListedFiles(source.parent, (source.name,))
    root = find_root(source)
    names: list[str] = []
    refused: list[str] = []
    for folder, folders, files in os.walk(root):
        base = Path(folder).relative_to(root).as_posix()
        base = "" if base == "." else base + "/"
        if base.count("/") > MAX_DEPTH:
            raise ImportRefusedError(f"{source}: folders are nested more than {MAX_DEPTH} deep.")
        folders[:] = sorted(name for name in folders if not _is_clutter(name))
        refused += [f"{base}{name} is a link to a folder" for name in folders if (Path(folder) / name).is_symlink()]
        for name in sorted(base + file for file in files if not _is_clutter(file)):
            fault = _find_fault(root, name)
            if fault:
                refused.append(fault)
            else:
                names.append(name)
        if len(names) > MAX_FILES:
            raise ImportRefusedError(f"{source}: holds more than {MAX_FILES} files.")
    return ListedFiles(root, tuple(sorted(names)), tuple(refused))


def _find_fault(root: Path, name: str) -> str:
    """Why a file is left out, with its name; empty for a plain file inside the folder."""
    if fault := find_path_fault(name):
        return f"{name!r} {fault}"
    path = root / name
    if path.is_symlink() and not is_inside(path, root):
        return f"{name} is a link out of the folder"
    return "" if path.is_file() else f"{name} is not a plain file"


def find_root(source: Path) -> Path:
    """The folder that a recording begins in: of a file its own, else the first one that holds more than a folder."""
    if source.is_file():
        return source.parent
    root = source
    for _ in range(MAX_DEPTH):
        entries = [entry for entry in os.scandir(root) if not _is_clutter(entry.name)]
        if len(entries) != 1 or not entries[0].is_dir(follow_symlinks=False):
            break
        root = Path(entries[0].path)
    return root


def _is_clutter(name: str) -> bool:
    return name.startswith(".") or name in {"__MACOSX", "Thumbs.db", "desktop.ini"}

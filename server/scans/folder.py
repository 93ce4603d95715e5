"""The scans in the files of an upload, and what a `scans.json` among them says."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from server.database.texts import Label, Name
from server.errors import InvalidError
from server.scans.schemas import Side, UnitScale
from server.storage.sent_json import reading_json
from tracker import say_count

SUFFIXES = (".ply", ".obj", ".stl")
LIST_NAME = "scans.json"
NEEDED = (
    "a list of objects with `file`, and `subject`, `pose`, `side` (right or left) and `metres_per_unit` where they are "
    "known"
)
MAX_LIST_BYTES = 64 * 2**20


class ListedScan(BaseModel):
    """A line of `scans.json`."""

    model_config = ConfigDict(extra="ignore")

    file: str = Field(max_length=1000)
    name: Name | None = None
    subject: Label = ""
    pose: Label = ""
    side: Side | None = None
    metres_per_unit: UnitScale | None = None


@dataclass(frozen=True)
class FoundScans:
    """What lies in a folder.

    Attributes:
        root: The folder that names count from.
        scans: Scan files by their names.
        listed: What `scans.json` says of each, by name; of files that are not there too.
        others: Files of other kinds.
    """

    root: Path
    scans: dict[str, Path]
    listed: dict[str, ListedScan]
    others: int

    def write_notes(self) -> list[str]:
        """What a person should know of the folder beside its scans, sentences."""
        missing = [name for name in self.listed if name not in self.scans]
        notes = []
        if missing:
            notes.append(
                f"{LIST_NAME} names {say_count(len(missing), 'file that is', 'files that are')} not there, such as "
                f"{missing[0][:200]!r}."
            )
        if self.others:
            notes.append(f"{say_count(self.others, 'other file was', 'other files were')} ignored.")
        return notes

    def hide_root(self, text: str) -> str:
        """A message without the folder's own place on this machine."""
        return text.replace(f"{self.root}/", "")


def find_scans(folder: Path) -> FoundScans:
    """The scans that a folder holds, at any depth; or one file. Raises when there are none."""
    paths = [folder] if folder.is_file() else sorted(path for path in folder.rglob("*") if path.is_file())
    root = folder.parent if folder.is_file() else folder
    listed = _read_lists([path for path in paths if path.name == LIST_NAME], root)
    scans = [path for path in paths if path.suffix.lower() in SUFFIXES]
    if not scans:
        raise InvalidError(
            f"There are no scans in it; needed files that end in {', '.join(SUFFIXES)}, or a zip of them."
        )
    others = len(paths) - len(scans) - sum(path.name == LIST_NAME for path in paths)
    return FoundScans(root, {path.relative_to(root).as_posix(): path for path in scans}, listed, others)


def _read_lists(paths: Iterable[Path], root: Path) -> dict[str, ListedScan]:
    """Lines of every `scans.json`, by the path of the file from the root."""
    found: dict[str, ListedScan] = {}
    for path in paths:
        name = path.relative_to(root).as_posix()
        if path.stat().st_size > MAX_LIST_BYTES:
            raise InvalidError(f"{name} has more than {MAX_LIST_BYTES} bytes.")
        with reading_json(name, NEEDED):
            document = json.loads(path.read_bytes())
            lines = document["scans"] if isinstance(document, dict) else document
            read = [ListedScan.model_validate(line) for line in lines]
        base = path.parent.relative_to(root).as_posix()
        found |= {line.file if base == "." else f"{base}/{line.file}": line for line in read}
    return found

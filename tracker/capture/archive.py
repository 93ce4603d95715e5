"""Unpack a zip that came from outside: all of it, inside one folder, or nothing."""

from __future__ import annotations

import shutil
import stat
import struct
import unicodedata
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, cast

from tracker.capture.relative_path import find_path_fault
from tracker.capture.workplace import make_workplace
from tracker.errors import ImportRefusedError, reading

_GIB = 1024**3
"""Bytes."""


@dataclass(frozen=True)
class ArchiveLimits:
    """What an archive may hold.

    Attributes:
        files: Entries.
        total_bytes: Unpacked, all together.
        file_bytes: Unpacked, each.
        ratio: Unpacked to packed bytes, for entries and for the whole; recordings are images and hardly shrink.
        free_ratio_bytes: Unpacked sizes below are never refused for their ratio.
        depth: Folders in folders.
        directory_bytes: Of the table of contents.
    """

    files: int = 2_000_000
    total_bytes: int = 256 * _GIB
    file_bytes: int = 32 * _GIB
    ratio: float = 200.0
    free_ratio_bytes: int = 16 * 1024 * 1024
    depth: int = 12
    directory_bytes: int = 512 * 1024 * 1024


def extract_archive(archive: Path | str, folder: Path | str, limits: ArchiveLimits | None = None) -> list[str]:
    """Unpack a zip into a folder that is not there yet (or is empty). Archives in it stay packed.

    Returns:
        Relative names of the files.

    Raises:
        ImportRefusedError: Something in it is not safe, too large or damaged; nothing is left behind.
    """
    archive, folder = Path(archive), Path(folder)
    limits = limits or ArchiveLimits()
    if folder.is_symlink() or (folder.exists() and (not folder.is_dir() or any(folder.iterdir()))):
        raise ImportRefusedError(f"{folder}: something is there already.")
    with reading(ImportRefusedError, archive.name, "a valid zip archive; pack it again"):
        try:
            _check_directory_size(archive, limits)
            with zipfile.ZipFile(archive) as file:
                entries = _check_entries(file, archive, limits)
                with make_workplace(folder) as workplace:
                    _check_space(workplace, entries, archive)
                    for entry in entries:
                        _extract(file, entry, workplace)
        except OSError as cause:  # the disk's fault, not the archive's
            raise ImportRefusedError(f"{archive.name}: cannot be unpacked ({cause.strerror or cause}).") from cause
    return [entry.filename for entry in entries if not entry.is_dir()]


def _check_directory_size(archive: Path, limits: ArchiveLimits) -> None:
    """Refuse a giant table of contents before `zipfile` reads it into memory."""
    if not archive.is_file():
        raise ImportRefusedError(f"{archive.name}: there is no such file.")
    with archive.open("rb") as file:
        length = file.seek(0, 2)
        file.seek(max(0, length - 65_557 - 20))
        tail = file.read()
        at = tail.rfind(b"PK\x05\x06")
        if at < 0 or len(tail) < at + 22:
            hint = "" if length else " (it is empty)"
            raise ImportRefusedError(f"{archive.name}: is not a zip archive{hint}; pack the folder as .zip.")
        size = struct.unpack_from("<I", tail, at + 12)[0]
        if at >= 20 and tail[at - 20 : at - 16] == b"PK\x06\x07":
            file.seek(min(struct.unpack_from("<Q", tail, at - 12)[0], length))
            record = file.read(56)
            if len(record) == 56 and record.startswith(b"PK\x06\x06"):
                size = struct.unpack_from("<Q", record, 40)[0]
    if size > limits.directory_bytes:
        raise ImportRefusedError(f"{archive.name}: its table of contents has {size} bytes; this is not a recording.")


def _check_entries(file: zipfile.ZipFile, archive: Path, limits: ArchiveLimits) -> list[zipfile.ZipInfo]:
    """All entries, checked by what the archive says about them."""
    entries = file.infolist()
    if len(entries) > limits.files:
        raise ImportRefusedError(f"{archive.name}: holds {len(entries)} files; at most {limits.files} are unpacked.")
    for entry in entries:
        fault = _find_entry_fault(entry, limits)
        if fault:
            raise ImportRefusedError(f"{archive.name}: {entry.orig_filename[:120]!r} {fault}.")
    _check_names(entries, archive)
    total, packed = sum(e.file_size for e in entries), sum(e.compress_size for e in entries)
    if total > limits.total_bytes:
        raise ImportRefusedError(
            f"{archive.name}: unpacks to {total} bytes; at most {limits.total_bytes} are unpacked."
        )
    if packed > archive.stat().st_size:
        raise ImportRefusedError(f"{archive.name}: its files overlap; that is a zip bomb.")
    if total > limits.free_ratio_bytes and total > limits.ratio * max(packed, 1):
        raise ImportRefusedError(f"{archive.name}: unpacks to {total / max(packed, 1):.0f} times its size; a zip bomb?")
    return entries


def _find_entry_fault(entry: zipfile.ZipInfo, limits: ArchiveLimits) -> str:
    """What is wrong with an entry; empty when nothing is."""
    name = entry.orig_filename.removesuffix("/")
    kind = stat.S_IFMT(entry.external_attr >> 16)
    if fault := find_path_fault(name):
        return fault
    if name.count("/") > limits.depth:
        return f"lies more than {limits.depth} folders deep"
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR) or (kind == stat.S_IFDIR and not entry.is_dir()):
        return "is a link or a device; pack the file itself"
    if entry.flag_bits & 0x1:
        return "is encrypted; pack it without a password"
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        return "is packed with an unusual method; pack it as a usual zip (deflate)"
    if entry.is_dir() and entry.file_size:
        return "is a folder with content of its own"
    if entry.file_size > limits.file_bytes:
        return f"unpacks to {entry.file_size} bytes; at most {limits.file_bytes} a file are unpacked"
    if entry.file_size > limits.free_ratio_bytes and entry.file_size > limits.ratio * max(entry.compress_size, 1):
        return f"unpacks to {entry.file_size / max(entry.compress_size, 1):.0f} times its size; a zip bomb?"
    return ""


def _check_names(entries: list[zipfile.ZipInfo], archive: Path) -> None:
    """No two entries may mean the same file on any system, and no file may also be a folder."""
    files: dict[str, str] = {}
    folders: set[str] = set()
    for entry in entries:
        plain = unicodedata.normalize("NFKC", entry.filename.removesuffix("/")).casefold()
        parts = plain.split("/")
        folders.update("/".join(parts[:n]) for n in range(1, len(parts) + entry.is_dir()))
        if entry.is_dir():
            continue
        if plain in files:
            raise ImportRefusedError(f"{archive.name}: {files[plain]!r} and {entry.filename!r} mean the same file.")
        files[plain] = entry.filename
    if both := folders & files.keys():
        raise ImportRefusedError(f"{archive.name}: {min(both)!r} is a file and a folder.")


def _check_space(workplace: Path, entries: list[zipfile.ZipInfo], archive: Path) -> None:
    total, free = sum(e.file_size for e in entries), shutil.disk_usage(workplace).free
    if total > free:
        raise ImportRefusedError(f"{archive.name}: needs {total} bytes of disk; {free} are free.")


def _extract(file: zipfile.ZipFile, entry: zipfile.ZipInfo, workplace: Path) -> None:
    """Write one entry; it may not give more than it promised, and its checksum must hold."""
    target = workplace / entry.filename
    if entry.is_dir():
        target.mkdir(parents=True, exist_ok=True)
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    written = 0
    with target.open("xb") as output:
        for chunk in _read(file, entry):
            written += len(chunk)
            if written > entry.file_size:
                raise ImportRefusedError(
                    f"{entry.filename}: unpacks to more than the {entry.file_size} bytes that its header states."
                )
            output.write(chunk)
    if written != entry.file_size:
        raise ImportRefusedError(
            f"{entry.filename}: unpacks to {written} of the {entry.file_size} bytes that its header states."
        )


def _read(file: zipfile.ZipFile, entry: zipfile.ZipInfo) -> Iterator[bytes]:
    with file.open(entry) as stream:
        while chunk := cast(BinaryIO, stream).read(1024 * 1024):
            yield chunk

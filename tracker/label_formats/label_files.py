"""Files of labels: read from a folder, a file or a zip within limits, packed the same way every time."""

from __future__ import annotations

import io
import tempfile
import zipfile
from pathlib import Path

from tracker.capture.archive import ArchiveLimits, extract_archive
from tracker.capture.atomic_file import write_atomically
from tracker.capture.document import read_regular_file
from tracker.errors import AnnotationError

MAX_BYTES = 256 * 1024 * 1024
"""Of one file."""
MAX_FILES = 100_000
"""Of one import."""
LIMITS = ArchiveLimits(files=MAX_FILES, total_bytes=MAX_BYTES, file_bytes=MAX_BYTES, directory_bytes=64 * 1024 * 1024)
SUFFIXES = (".json", ".csv", ".txt")
REFUSED = {
    ".pkl": "pickles are programs; export the labels as JSON or CSV",
    ".pickle": "pickles are programs; export the labels as JSON or CSV",
    ".h5": "HDF5 is not read; DeepLabCut writes the same labels as .csv beside it",
}
MOMENT = (1980, 1, 1, 0, 0, 0)
"""Of all members of a zip, so that the same labels make the same bytes; the first that zip knows."""


def read_label_files(path: Path) -> dict[str, bytes]:
    """Text files below a folder, in a zip, or the one file, by relative name; others are passed over."""
    if path.is_file() and path.suffix.lower() == ".zip":
        with tempfile.TemporaryDirectory(prefix="handloom-labels-") as folder:
            extract_archive(path, Path(folder) / "files", LIMITS)
            return _read_folder(Path(folder) / "files")
    if path.is_dir():
        return _read_folder(path)
    if path.suffix.lower() in REFUSED:
        raise AnnotationError(f"{path.name}: {REFUSED[path.suffix.lower()]}.")
    if path.suffix.lower() not in SUFFIXES:
        raise AnnotationError(f"{path.name}: needed labels as .json, .csv or .txt, or a folder or .zip of these.")
    return {path.name: read_regular_file(path, MAX_BYTES, AnnotationError)}


def _read_folder(folder: Path) -> dict[str, bytes]:
    files: dict[str, bytes] = {}
    total, seen, refused = 0, 0, ""
    for path in sorted(folder.rglob("*")):
        seen += 1
        if seen > MAX_FILES:
            raise AnnotationError(f"{folder.name}: holds more than {MAX_FILES} files.")
        suffix = path.suffix.lower()
        if suffix in REFUSED:
            refused = f"{path.name}: {REFUSED[suffix]}."
        if suffix not in SUFFIXES or path.is_symlink() or not path.is_file():
            continue
        data = read_regular_file(path, MAX_BYTES, AnnotationError)
        total += len(data)
        if total > MAX_BYTES:
            raise AnnotationError(f"{folder.name}: holds more than {MAX_BYTES} bytes of labels.")
        files[path.relative_to(folder).as_posix()] = data
    if not files:
        raise AnnotationError(refused or f"{folder.name}: holds no .json, .csv or .txt; needed labels.")
    return files


def pack_files(files: dict[str, bytes]) -> bytes:
    """A zip with the same bytes for the same files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, MOMENT)
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, files[name], zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def save_label_files(out: Path, files: dict[str, bytes]) -> None:
    """Write an export: one file as that file, several as a zip if `out` ends so, else into a new folder."""
    if out.suffix.lower() == ".zip":
        write_atomically(out, pack_files(files))
    elif len(files) == 1:
        write_atomically(out, next(iter(files.values())))
    else:
        for name, data in files.items():
            path = out / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)

"""Names of files that come from outside: inside their folder, and nothing else."""

from __future__ import annotations

import re
import unicodedata
from contextlib import suppress
from pathlib import Path

MAX_PATH = 1024
"""Characters of a path."""
MAX_PART = 255
"""Characters of a name, as on ext4, NTFS and APFS."""
_DEVICES = re.compile(r"(?i)^(con|prn|aux|nul|conin\$|conout\$|com[0-9¹²³]|lpt[0-9¹²³])\s*(\..*)?$")


def find_path_fault(text: str) -> str:
    """What is wrong with a relative file name from outside; empty when nothing is.

    Allowed: parts joined by `/`, no `.` or `..`, nothing that another system takes for a drive, a device or a stream.
    """
    if not text:
        return "is empty"
    if len(text) > MAX_PATH:
        return f"is {len(text)} characters long, more than {MAX_PATH}"
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        return "is not valid text"
    if any(unicodedata.category(c) in ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp") for c in text):
        return "holds invisible or control characters"
    if "\\" in text:
        return "holds a backslash"
    if text.startswith("/"):
        return "is absolute"
    if ":" in text:
        return "holds a colon (a drive or a stream)"
    return next(filter(None, map(_find_part_fault, text.split("/"))), "")


def _find_part_fault(part: str) -> str:
    """The same of what stands between two `/`."""
    normal = unicodedata.normalize("NFKC", part)
    if part == "":
        return "has an empty part"
    if normal.strip(" .") == "" or any(sign in normal for sign in "/\\:"):
        return f"has a part {part!r} that leads out of the folder or stands for another name"
    if len(part.encode("utf-8")) > MAX_PART:
        return f"has a part longer than {MAX_PART} bytes"
    if part != part.rstrip(" .") or part != part.lstrip(" "):
        return f"has a part {part!r} that begins or ends in a space or ends in a dot"
    if _DEVICES.match(normal):
        return f"has a part {part!r} that names a device"
    return ""


def is_inside(path: Path, folder: Path) -> bool:
    """Whether path, with every symbolic link followed, lies in the folder; one that leads round does not."""
    try:
        with suppress(FileNotFoundError, NotADirectoryError):
            path.stat()  # `resolve` says nothing of a link that leads round from Python 3.13 on
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError, ValueError):
        return False

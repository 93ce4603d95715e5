"""Names of files that people download: what they are of comes first, and every system accepts them."""

from __future__ import annotations

import re
import unicodedata
from urllib.parse import quote

MAX_LENGTH = 120
_UNSAFE = re.compile(r'[\\/:*?"<>|\s]+')
_DEVICES = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?", re.IGNORECASE)


def make_file_name(parts: list[str], suffix: str) -> str:
    """`Take 7`, `labels`, `.json` become `Take_7-labels.json`: printable characters that every file system takes."""
    whole = "-".join(part for part in (_clean(part) for part in parts) if part)[:MAX_LENGTH].rstrip("-._")
    if not whole or _DEVICES.fullmatch(whole):
        whole = f"handloom-{whole}".rstrip("-")
    return whole + suffix


def name_download(*parts: str, suffix: str) -> dict[str, str]:
    """The header that gives a download its name (RFC 6266): in ASCII for old programs, and as it is written.

    Args:
        parts: What it is of, such as the recording's name, then what it is.
        suffix: With its dot.
    """
    name = make_file_name(list(parts), suffix)
    stem = unicodedata.normalize("NFKD", name.removesuffix(suffix)).encode("ascii", "ignore").decode().strip("-._")
    plain = (stem or "download") + suffix
    header = f'attachment; filename="{plain}"'
    return {"Content-Disposition": header if plain == name else f"{header}; filename*=UTF-8''{quote(name, safe='')}"}


def _clean(part: str) -> str:
    text = _UNSAFE.sub("_", unicodedata.normalize("NFC", part))
    return "".join(c for c in text if c.isprintable() and c not in "%;").strip("._-")

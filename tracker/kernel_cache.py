"""Where compiled kernels are kept.

numba notices when a file with kernels changes, but not when a kernel that it calls in another file does, or a constant
that it takes from there. So the folder of the cache carries a digest of every file with kernels, and a change in one
starts a new folder. A kernel takes functions and constants from such files only.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from pathlib import Path

ROOT = Path.home() / ".cache" / "handloom" / "kernels"

KEPT = 16
"""So many folders are kept, for those who go back and forth and for clones beside each other."""


def find_kernel_files(tracker: Path) -> dict[str, bytes]:
    """The files with kernels, by their path below the folder `tracker`, with what they hold."""
    paths = [path for path in tracker.rglob("*.py") if path.name != Path(__file__).name]
    texts = {path.relative_to(tracker).as_posix(): path.read_bytes() for path in sorted(paths)}
    return {name: text for name, text in texts.items() if b"njit" in text}


def choose_cache_folder(root: Path) -> Path:
    """The folder below `root` that belongs to the kernels as they are now."""
    files = find_kernel_files(Path(__file__).parent)
    digest = hashlib.sha256(b"".join(name.encode() + text for name, text in sorted(files.items()))).hexdigest()[:16]
    return root / digest


def use_kernel_cache() -> None:
    """Have numba keep compiled kernels in the user's cache, unless NUMBA_CACHE_DIR is set; before any kernel exists."""
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    folder = str(choose_cache_folder(ROOT))
    os.environ["NUMBA_CACHE_DIR"] = folder
    if "numba" in sys.modules:
        sys.modules["numba"].config.CACHE_DIR = folder


def remove_old_caches() -> None:
    """Remove all but the newest folders."""
    if ROOT.is_dir():
        folders = sorted(ROOT.iterdir(), key=lambda folder: folder.stat().st_mtime, reverse=True)
        for old in folders[KEPT:]:
            shutil.rmtree(old, ignore_errors=True)

"""Where compiled kernels are kept.

numba notices when a file with kernels changes, but not when a kernel that it calls in another file does. So the folder
of the cache carries a digest of every file whose kernels are called from elsewhere; a change there starts a new folder.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from pathlib import Path

SHARED_KERNELS = (
    "detection/channels.py",
    "detection/levels.py",
    "geometry/exits.py",
    "geometry/se3.py",
    "geometry/triangle_tree.py",
    "geometry/triangles.py",
    "model/blend_kernels.py",
    "observation/depth_edges.py",
    "observation/image_edges.py",
    "observation/observation.py",
    "registration/curved_triangles.py",
    "registration/nearest_grid.py",
    "rendering/zbuffer.py",
    "synthesis/scans/bones.py",
    "terms/colliding_parts.py",
    "terms/normal_equations.py",
    "terms/residual.py",
    "terms/surface_point.py",
    "training/linearize.py",
    "training/motion.py",
)
"""Files whose kernels, or whose constants, kernels of other files use."""

ROOT = Path.home() / ".cache" / "handloom" / "kernels"

KEPT = 4
"""So many folders are kept, for those who go back and forth."""


def choose_cache_folder(root: Path) -> Path:
    """The folder below `root` that belongs to the kernels as they are now."""
    here = Path(__file__).parent
    digest = hashlib.sha256(b"".join((here / name).read_bytes() for name in SHARED_KERNELS)).hexdigest()[:16]
    return root / digest


def use_kernel_cache() -> None:
    """Tell numba, before any kernel exists, to keep compiled kernels in the user's cache unless told otherwise."""
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

"""Poses of hands that generated people take: those of people whom nothing was learnt from."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

DATA = Path(__file__).parent / "data" / "hand_poses.npz"

MIRRORED = np.array([1.0, -1.0, -1.0])
"""A rotation vector seen in the mirror x = 0 that makes left hands of right ones."""


@cache
def load_hand_poses() -> tuple[Array, tuple[str, ...]]:
    """(N, 15, 3) rotation vectors of the fingers of a body's right hand, rad, and the name of each pose."""
    with np.load(DATA, allow_pickle=False) as arrays:
        return arrays["poses"].astype(np.float64), tuple(str(name) for name in arrays["names"])


def find_poses(name: str) -> Array:
    """(N, 15, 3) how different people hold the pose of that name."""
    poses, names = load_hand_poses()
    return poses[[each == name for each in names]]

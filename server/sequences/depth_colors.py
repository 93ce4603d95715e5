"""Pictures of depth: near is bright, far is dark, no value is transparent."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal

import cv2
import numpy as np
import numpy.typing as npt

Colormap = Literal["turbo", "viridis", "gray"]
_OPENCV = {"turbo": cv2.COLORMAP_TURBO, "viridis": cv2.COLORMAP_VIRIDIS}


@lru_cache
def load_palette(colormap: Colormap) -> npt.NDArray[np.uint8]:
    """(256, 3) RGB; entry 1 is the farthest, 255 the nearest, 0 (no value) black."""
    ramp = np.arange(256, dtype=np.uint8)[:, None]
    if colormap == "gray":
        palette = np.repeat(ramp, 3, axis=1)
    else:
        palette = cv2.applyColorMap(ramp, _OPENCV[colormap])[:, 0, ::-1]
    palette = np.ascontiguousarray(palette, np.uint8)
    palette[0] = 0
    return palette


@lru_cache(maxsize=16)
def _make_table(near: float, far: float, scale: float) -> npt.NDArray[np.uint8]:
    depth = np.arange(65536) * scale
    table = np.clip(np.rint(255 - 254 * (depth - near) / (far - near)), 1, 255).astype(np.uint8)
    table[0] = 0
    return table


def index_depth(raw: npt.NDArray[np.uint16], scale: float, near: float, far: float) -> npt.NDArray[np.uint8]:
    """(H, W) palette indices of raw depth in units of `scale` m: 255 at `near` m, 1 at `far` m, 0 for no value."""
    assert far > near >= 0, (near, far)
    return _make_table(near, far, scale)[raw]

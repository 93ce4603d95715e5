"""Points and meshes as the browser takes them: one binary answer that it can lay arrays over without copying.

    "HLG1", uint32 length of the header, header (JSON, padded with spaces), then the arrays

all little-endian, each array from a multiple of 8 bytes on. The header
names each array with its type, shape and place after the header:
`{"arrays": [{"name": "positions", "type": "uint16", "shape": [20000, 3], "offset": 0}], ...}`.
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

MAGIC = b"HLG1"
ALIGNMENT = 8
MEDIA_TYPE = "application/vnd.handloom.geometry"
CROPPED, LEFT_OUT = 1, 2
"""Of `flags`."""


def pack_arrays(arrays: dict[str, np.ndarray], members: dict[str, Any]) -> bytes:
    """Arrays and further members as bytes.

    Args:
        arrays: uint8, int8, uint16, uint32 or float32 by name.
        members: Further members of the header.
    """
    described, parts, offset = [], [], 0
    for name, array in arrays.items():
        data = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).tobytes()
        described.append({"name": name, "type": array.dtype.name, "shape": list(array.shape), "offset": offset})
        padding = -len(data) % ALIGNMENT
        parts += [data, bytes(padding)]
        offset += len(data) + padding
    header = json.dumps({**members, "arrays": described}, separators=(",", ":")).encode()
    header += b" " * (-(len(header) + len(MAGIC) + 4) % ALIGNMENT)
    return b"".join([MAGIC, struct.pack("<I", len(header)), header, *parts])


def quantise(points: np.ndarray) -> tuple[np.ndarray, dict[str, Any]]:
    """(N, 3) m as uint16 over their box; position = origin_m + step_m * number. 3 micrometres for a hand."""
    low = points.min(axis=0) if len(points) else np.zeros(3)
    high = points.max(axis=0) if len(points) else np.zeros(3)
    step = np.maximum((high - low) / 65535.0, 1e-12)
    numbers = np.round((points - low) / step).astype(np.uint16)
    return numbers, {"origin_m": low.tolist(), "step_m": step.tolist()}


def choose_points(count: int, size: int, digest: str) -> np.ndarray:
    """Indices of at most `size` of `count` points, spread at random but the same each time; a smaller choice is the
    beginning of a larger one."""
    order = np.random.default_rng(int(digest[:16], 16)).permutation(count)
    return order[:size]


def pack_scan(
    points: np.ndarray,
    normals: np.ndarray,
    colors: np.ndarray | None,
    flags: np.ndarray,
    size: int,
    digest: str,
) -> bytes:
    """A scan for the browser: positions, normals (x127), colours if it has any, flags."""
    chosen = choose_points(len(points), size, digest)
    positions, members = quantise(points[chosen])
    arrays = {"positions": positions, "normals": np.round(127.0 * normals[chosen]).astype(np.int8)}
    if colors is not None:
        arrays["colors"] = colors[chosen]
    arrays["flags"] = flags[chosen]
    return pack_arrays(arrays, {**members, "point_count": len(points)})

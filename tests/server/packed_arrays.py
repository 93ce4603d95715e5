"""The arrays of a body as `server.scans.geometry.pack_arrays` makes it, read as the browser reads them."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

from server.scans.geometry import MAGIC


def unpack_arrays(data: bytes) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """What `pack_arrays` has packed."""
    assert data[:4] == MAGIC
    (length,) = struct.unpack("<I", data[4:8])
    members = json.loads(data[8 : 8 + length])
    arrays = {}
    for item in members.pop("arrays"):
        kind, shape = np.dtype(item["type"]).newbyteorder("<"), tuple(item["shape"])
        start = 8 + length + item["offset"]
        count = int(np.prod(shape))
        arrays[item["name"]] = np.frombuffer(data, kind, count, start).reshape(shape)
    return arrays, members

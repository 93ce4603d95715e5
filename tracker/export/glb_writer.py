"""Writing .glb files: JSON and one buffer with everything that is numbers."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.model.gltf_container import CHUNK_BIN, CHUNK_JSON, GLB_MAGIC

KINDS = {"uint8": 5121, "uint16": 5123, "uint32": 5125, "float32": 5126}
"""glTF's numbers of its kinds of number."""
FORMS = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963
"""glTF's targets of a view: attributes of vertices, indices."""


class GlbWriter:
    """Collects accessors; `finish` gives the bytes of the file."""

    def __init__(self) -> None:
        self._data = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []

    def add(self, values: npt.NDArray, *, target: int | None = None, bounded: bool = False) -> int:
        """Store values (N, width), or (N,) for scalars; gives the index of their accessor.

        Args:
            values: uint8, uint16, uint32 or float32.
            target: ARRAY_BUFFER for attributes of vertices, ELEMENT_BUFFER for indices.
            bounded: Also store the range, which glTF wants of positions and times.
        """
        rows = np.atleast_2d(values.T).T
        self._data += b"\0" * (-len(self._data) % 4)
        view = {"buffer": 0, "byteOffset": len(self._data), "byteLength": rows.nbytes}
        self._views.append(view if target is None else view | {"target": target})
        self._data += rows.astype(rows.dtype.newbyteorder("<")).tobytes()
        accessor: dict[str, Any] = {
            "bufferView": len(self._views) - 1,
            "componentType": KINDS[rows.dtype.name],
            "count": len(rows),
            "type": FORMS[rows.shape[1]],
        }
        if bounded:
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def finish(self, document: dict[str, Any]) -> bytes:
        """The file of the document, which names accessors by the indices that `add` gave."""
        binary = bytes(self._data) + b"\0" * (-len(self._data) % 4)
        document = document | {
            "bufferViews": self._views,
            "accessors": self._accessors,
            "buffers": [{"byteLength": len(binary)}],
        }
        text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode("utf-8")
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(binary)
        return b"".join(
            (
                struct.pack("<III", GLB_MAGIC, 2, length),
                struct.pack("<II", len(text), CHUNK_JSON),
                text,
                struct.pack("<II", len(binary), CHUNK_BIN),
                binary,
            )
        )

"""Reading .glb and .gltf files from anywhere: JSON, buffers and accessors, each checked before it is used."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from tracker.errors import ModelFileError, reading, reads
from tracker.model.file_limits import MAX_BYTES

GLB_MAGIC = 0x46546C67
""""glTF", as the two below from the specification of glTF 2.0."""
CHUNK_JSON = 0x4E4F534A
CHUNK_BIN = 0x004E4942

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""NumPy's names of glTF's kinds of number."""
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

IGNORABLE = ("KHR_materials", "KHR_texture", "EXT_texture", "KHR_lights")
"""Extensions that a file may require and that do not touch the geometry."""


@dataclass(frozen=True)
class Gltf:
    """The parsed JSON of a file and the bytes of its buffers."""

    path: Path
    document: dict[str, Any]
    buffers: tuple[bytes, ...]

    def fail(self, found: str, needed: str) -> ModelFileError:
        return ModelFileError(self.path, found, needed)

    def item(self, kind: str, index: Any) -> dict[str, Any]:
        """Entry of a top-level list such as "meshes"."""
        items = self.document.get(kind, [])
        if type(index) is not int or not isinstance(items, list) or not 0 <= index < len(items):
            raise self.fail(f"a reference to {kind}[{str(index)[:20]}], which is not there", f"an entry of '{kind}'")
        if not isinstance(items[index], dict):
            raise self.fail(f"{kind}[{index}] that is not an object", "an object")
        return items[index]

    def accessor(self, index: Any, form: str) -> npt.NDArray:
        """Values (N, width) of an accessor of the type `form`; normalised integers become -1 or 0 to 1."""
        accessor = self.item("accessors", index)
        self._check_accessor(accessor, index, form)
        dtype, width = np.dtype(COMPONENTS[accessor["componentType"]]), WIDTHS[form]
        rows = self._rows(accessor, index, dtype.itemsize * width)
        values = np.ascontiguousarray(rows).view(dtype).reshape(len(rows), width)
        if accessor.get("normalized") is True and dtype.kind in "ui":
            return np.maximum(values.astype(np.float64) / np.iinfo(dtype).max, -1.0)
        if dtype.kind == "f" and not np.all(np.isfinite(values)):
            raise self.fail(f"accessors[{index}] with numbers that are not finite", "finite numbers")
        return values

    def _check_accessor(self, accessor: dict[str, Any], index: Any, form: str) -> None:
        component, count = accessor.get("componentType"), accessor.get("count")
        if accessor.get("type") != form or type(component) is not int or type(count) is not int:
            raise self.fail(f"accessors[{index}] of type {str(accessor.get('type'))[:20]}", f"a {form} of numbers")
        if component not in COMPONENTS:
            raise self.fail(f"accessors[{index}] of numbers of the kind {component}", "a kind of number of glTF 2.0")
        if "sparse" in accessor or "bufferView" not in accessor:
            raise self.fail(f"a sparse or empty accessors[{index}]", "plain accessors; export without sparse data")

    def _rows(self, accessor: dict[str, Any], index: Any, size: int) -> npt.NDArray[np.uint8]:
        """The `size` bytes of each entry of an accessor, (N, size), as they stand in its buffer."""
        view, count = self.item("bufferViews", accessor["bufferView"]), accessor["count"]
        stride = self._whole(view, "byteStride", size)
        offset = self._whole(accessor, "byteOffset", 0)
        start, length = self._whole(view, "byteOffset", 0), self._whole(view, "byteLength", -1)
        number = view.get("buffer")
        if type(number) is not int or not 0 <= number < len(self.buffers):
            raise self.fail(f"bufferViews with the buffer {str(number)[:20]}", f"one of {len(self.buffers)} buffers")
        data = self.buffers[number]
        fits = count >= 1 and stride >= size and length >= 0 and start + length <= len(data)
        if not fits or offset + stride * (count - 1) + size > length or count * size > MAX_BYTES:
            raise self.fail(f"accessors[{index}] that runs past the end of its buffer", "a whole file")
        return np.lib.stride_tricks.as_strided(
            np.frombuffer(data, dtype=np.uint8)[start + offset :], shape=(count, size), strides=(stride, 1)
        )

    def primitives(self, mesh: Any) -> list[dict[str, Any]]:
        """Those of a mesh."""
        found = self.item("meshes", mesh).get("primitives")
        if not isinstance(found, list) or not all(isinstance(primitive, dict) for primitive in found):
            raise self.fail("a mesh without primitives", "triangles")
        return found

    def triangles(self, primitive: dict[str, Any]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
        """Vertices (V, 3) and faces (F, 3) of a primitive of triangles."""
        attributes = primitive.get("attributes")
        if primitive.get("mode", 4) != 4 or not isinstance(attributes, dict):
            raise self.fail("a primitive that is not made of triangles", "triangles (mode 4)")
        points = self.accessor(attributes.get("POSITION"), "VEC3").astype(np.float64)
        has_indices = "indices" in primitive
        ids = self.accessor(primitive["indices"], "SCALAR").ravel() if has_indices else np.arange(len(points))
        if ids.dtype.kind not in "ui" or len(ids) % 3 or ids.max() >= len(points) or ids.min() < 0:
            raise self.fail(f"{len(ids)} indices up to {ids.max()} for {len(points)} vertices", "whole triangles")
        return points, ids.astype(np.int64).reshape(-1, 3)

    def _whole(self, entry: dict[str, Any], name: str, default: int) -> int:
        value = entry.get(name, default)
        if type(value) is not int or (value < default and default >= 0 and name != "byteStride") or abs(value) > 2**40:
            raise self.fail(f"'{name}' {str(value)[:20]}", "a whole number of bytes")
        return value


@reads(ModelFileError, "a glTF 2.0 file")
def read_gltf(path: Path) -> Gltf:
    """Read a .glb, or a .gltf with the buffers it names inside its own folder or as data URIs.

    Raises:
        ModelFileError: Damaged, too large, or reaching outside its folder.
    """
    path = Path(path)
    size = path.stat().st_size
    if size > MAX_BYTES:
        raise ModelFileError(path, f"{size} bytes", f"at most {MAX_BYTES} bytes")
    data = path.read_bytes()
    text, binary = _split_glb(path, data) if data[:4] == b"glTF" else (data, None)
    document = json.loads(text.decode("utf-8"))
    if not isinstance(document, dict):
        raise ModelFileError(path, "JSON that is not an object", "a glTF 2.0 file")
    asset = document.get("asset")
    version = asset.get("version") if isinstance(asset, dict) else None
    if not isinstance(version, str) or not version.startswith("2."):
        raise ModelFileError(path, f"glTF version {str(version)[:20]}", "glTF 2.0")
    required = document.get("extensionsRequired", [])
    blocking = (
        [str(name) for name in required if not str(name).startswith(IGNORABLE)] if isinstance(required, list) else []
    )
    if blocking:
        raise ModelFileError(path, f"the extension {blocking[0][:60]}", "geometry without compression or extensions")
    return Gltf(path, document, tuple(_read_buffers(path, document, binary)))


def _split_glb(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    if len(data) < 20:
        raise ModelFileError(path, f"{len(data)} bytes", "a whole .glb")
    magic, version, length = struct.unpack_from("<III", data, 0)
    if magic != GLB_MAGIC or version != 2 or length > len(data):
        raise ModelFileError(
            path, f"a .glb of version {version} with {len(data)} of {length} bytes", "a whole .glb 2.0"
        )
    text, binary = None, None
    position = 12
    while position + 8 <= length:
        size, kind = struct.unpack_from("<II", data, position)
        chunk = data[position + 8 : position + 8 + size]
        if len(chunk) != size:
            raise ModelFileError(path, "a chunk cut short", "a whole .glb")
        if kind == CHUNK_JSON and text is None:
            text = chunk
        elif kind == CHUNK_BIN and binary is None:
            binary = chunk
        position += 8 + size
    if text is None:
        raise ModelFileError(path, "no JSON chunk", "a .glb with its JSON chunk")
    return text, binary


def _read_buffers(path: Path, document: dict[str, Any], binary: bytes | None) -> list[bytes]:
    entries = document.get("buffers", [])
    if not isinstance(entries, list) or len(entries) > 64 or not all(isinstance(entry, dict) for entry in entries):
        raise ModelFileError(path, "'buffers' that is not a list of at most 64 objects", "a list of buffers")
    buffers: list[bytes] = []
    for number, entry in enumerate(entries):
        uri = entry.get("uri")
        if uri is None:
            if number != 0 or binary is None:
                raise ModelFileError(path, f"buffers[{number}] without data", "its data in the .glb or a 'uri'")
            buffers.append(binary)
        elif not isinstance(uri, str):
            raise ModelFileError(
                path, f"buffers[{number}] with a uri that is not a text", "a relative file name or data URI"
            )
        elif uri.startswith("data:"):
            buffers.append(_decode_data_uri(path, uri))
        else:
            buffers.append(_read_neighbour(path, uri))
        if sum(len(buffer) for buffer in buffers) > MAX_BYTES:
            raise ModelFileError(path, "buffers that are too large together", f"at most {MAX_BYTES} bytes")
    return buffers


def _decode_data_uri(path: Path, uri: str) -> bytes:
    head, _, body = uri.partition(",")
    if not head.endswith(";base64"):
        raise ModelFileError(path, f"the data URI {head[:40]!r}", "base64 data")
    with reading(ModelFileError, path, "base64 in its data URIs"):
        return base64.b64decode(body, validate=True)


def _read_neighbour(path: Path, uri: str) -> bytes:
    needed = "a buffer file in the same folder"
    name = unquote(uri)
    if "://" in uri or ":" in name or "\\" in name or "\0" in name or name.startswith("/"):
        raise ModelFileError(path, f"the buffer {uri[:80]!r}", needed)
    folder = path.parent.resolve()
    with reading(ModelFileError, path, needed):
        target = (folder / name).resolve()
        if not target.is_relative_to(folder) or not target.is_file():
            raise ModelFileError(path, f"the buffer {uri[:80]!r}, which is not in its folder", needed)
        if target.stat().st_size > MAX_BYTES:
            raise ModelFileError(
                path, f"the buffer {uri[:80]!r} of {target.stat().st_size} bytes", f"at most {MAX_BYTES}"
            )
        return target.read_bytes()

"""glTF files from anywhere: accessors are what NumPy wrote, and what reaches past a buffer is refused."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.errors import ModelFileError
from tracker.model.gltf_container import CHUNK_BIN, CHUNK_JSON, COMPONENTS, WIDTHS, Gltf, read_gltf

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4")


def one_accessor(data: bytes, **changes: Any) -> Gltf:
    """A file of one accessor; `changes` go to the accessor, those of `view` to its view."""
    accessor = {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"} | changes
    view = {"buffer": 0, "byteLength": len(data)} | accessor.pop("view", {})
    return Gltf(Path("a.glb"), {"accessors": [accessor], "bufferViews": [view]}, (data,))


def glb(document: Any, binary: bytes | None = None, **head: int) -> bytes:
    text = json.dumps(document).encode()
    chunks = struct.pack("<II", head.get("json", len(text)), CHUNK_JSON) + text
    if binary is not None:
        chunks += struct.pack("<II", head.get("bin", len(binary)), CHUNK_BIN) + binary
    return b"glTF" + struct.pack("<II", head.get("version", 2), head.get("length", 12 + len(chunks))) + chunks


@given(st.sampled_from(sorted(COMPONENTS)), st.sampled_from(sorted(WIDTHS)), st.integers(1, 5), st.data())
def test_an_accessor_gives_the_values_at_its_offset_and_stride(component: int, form: str, count: int, data) -> None:
    dtype, width = np.dtype(COMPONENTS[component]), WIDTHS[form]
    values = np.arange(count * width).reshape(count, width).astype(dtype)
    gap, before, offset = (data.draw(st.integers(0, 9)) for _ in range(3))
    rows = b"".join(row.tobytes() + b"\xff" * gap for row in values)
    gltf = one_accessor(
        b"\xff" * (before + offset) + rows,
        componentType=component,
        count=count,
        type=form,
        byteOffset=offset,
        view={"byteOffset": before, "byteLength": offset + len(rows), "byteStride": dtype.itemsize * width + gap},
    )
    np.testing.assert_array_equal(gltf.accessor(0, form), values)


def test_normalised_integers_are_shares_of_their_largest() -> None:
    gltf = one_accessor(bytes([0, 51, 255]), componentType=5121, type="SCALAR", normalized=True)
    np.testing.assert_allclose(gltf.accessor(0, "SCALAR")[:, 0], [0.0, 0.2, 1.0])
    signed = one_accessor(bytes([0x80, 0x81, 127]), componentType=5120, type="SCALAR", normalized=True)
    np.testing.assert_allclose(signed.accessor(0, "SCALAR")[:, 0], [-1.0, -1.0, 1.0])


NUMBER = st.one_of(st.integers(-(2**70), 2**70), st.integers(-40, 40), st.none(), st.booleans(), st.floats(), st.text())


@given(
    st.dictionaries(st.sampled_from(["componentType", "count", "byteOffset", "bufferView"]), NUMBER),
    st.dictionaries(st.sampled_from(["byteOffset", "byteLength", "byteStride", "buffer"]), NUMBER),
)
def test_whatever_an_accessor_claims_it_never_reaches_past_its_buffer(claims: dict, view: dict) -> None:
    data = TRIANGLE.tobytes()
    try:
        values = one_accessor(data, **claims, view=view).accessor(0, "VEC3")
    except ModelFileError:
        return
    assert values.ndim == 2 and values.shape[1] == 3 and len(values) <= len(data)
    assert all(row.astype(values.dtype).tobytes() in data for row in values)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused(bad: float) -> None:
    points = TRIANGLE.copy()
    points[1, 1] = bad
    with pytest.raises(ModelFileError, match="not finite"):
        one_accessor(points.tobytes()).accessor(0, "VEC3")


@pytest.mark.parametrize(
    ("ids", "told"), [([0, 1, 3], "up to 3 for 3"), ([0, 1], "2 indices"), ([-1, 0, 1], "indices")]
)
def test_triangles_are_of_vertices_that_are_there(ids: list[int], told: str) -> None:
    data = TRIANGLE.tobytes() + np.array(ids, "<i2").tobytes()
    gltf = Gltf(
        Path("a.glb"),
        {
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"bufferView": 0, "byteOffset": 36, "componentType": 5122, "count": len(ids), "type": "SCALAR"},
            ],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
        },
        (data,),
    )
    with pytest.raises(ModelFileError, match=told):
        gltf.triangles({"attributes": {"POSITION": 0}, "indices": 1})
    assert gltf.triangles({"attributes": {"POSITION": 0}})[1].tolist() == [[0, 1, 2]]


DOCUMENT = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36}]}


def test_the_three_ways_to_hold_a_buffer_give_the_same_bytes(tmp_path: Path) -> None:
    data = TRIANGLE.tobytes()
    (tmp_path / "a.glb").write_bytes(glb(DOCUMENT, data))
    uris = {"inside.gltf": f"data:application/octet-stream;base64,{base64.b64encode(data).decode()}"}
    (tmp_path / "the data.bin").write_bytes(data)
    uris["beside.gltf"] = "the%20data.bin"
    for name, uri in uris.items():
        (tmp_path / name).write_text(json.dumps(DOCUMENT | {"buffers": [{"uri": uri, "byteLength": 36}]}))
    for name in ("a.glb", *uris):
        assert read_gltf(tmp_path / name).buffers == (data,), name


@pytest.mark.parametrize(
    "uri", ["../a.bin", "/etc/hostname", "https://a.b/c.bin", "C:\\a.bin", "a\0b", "link.bin", "."]
)
def test_a_buffer_outside_of_its_folder_is_refused(uri: str, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (tmp_path / "a.bin").write_bytes(b"secret")
    (folder / "link.bin").symlink_to(tmp_path / "a.bin")
    (folder / "a.gltf").write_text(json.dumps(DOCUMENT | {"buffers": [{"uri": uri}]}))
    with pytest.raises(ModelFileError, match="same folder"):
        read_gltf(folder / "a.gltf")


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"glTF\2\0\0\0", "8 bytes"),
        (glb(DOCUMENT, version=1), "version 1"),
        (glb(DOCUMENT, length=9999), "of 9999 bytes"),
        (glb(DOCUMENT, json=2**32 - 1), "cut short"),
        (glb(DOCUMENT, b"abc", bin=4), "cut short"),
        (glb(DOCUMENT), "without data"),
        (b"glTF" + struct.pack("<IIII", 2, 20, 0, CHUNK_BIN), "no JSON chunk"),
        (glb([]), "not an object"),
        (glb({"asset": {"version": "1.0"}}), "glTF version 1.0"),
        (glb({"asset": {"version": "2.0"}, "buffers": [{}] * 65}), "at most 64"),
        (glb(DOCUMENT | {"extensionsRequired": ["KHR_draco_mesh_compression"]}), "KHR_draco"),
        (b"[" * 20_000, "damaged"),
    ],
)
def test_a_file_that_is_not_what_its_head_says_is_refused(data: bytes, told: str, tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(data)
    with pytest.raises(ModelFileError, match=told):
        read_gltf(tmp_path / "a.glb")

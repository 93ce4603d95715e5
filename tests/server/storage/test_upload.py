"""Uploads as they arrive: in pieces of any size, with names of any kind."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from server.errors import InvalidError, TooLargeError
from server.storage.upload import MAX_FIELD_BYTES, Upload, receive_upload

BOUNDARY = "----b7"
KIND = f"multipart/form-data; boundary={BOUNDARY}"


def write_body(files: dict[str, bytes], fields: dict[str, str]) -> bytes:
    parts = [(f'name="files"; filename="{name}"\r\nContent-Type: image/png', data) for name, data in files.items()]
    parts += [(f'name="{name}"', text.encode()) for name, text in fields.items()]
    body = b"".join(
        f"--{BOUNDARY}\r\nContent-Disposition: form-data; {head}\r\n\r\n".encode() + data + b"\r\n"
        for head, data in parts
    )
    return body + f"--{BOUNDARY}--\r\n".encode()


def receive(folder: Path, body: bytes, piece: int = 65536) -> Upload:
    async def stream() -> AsyncIterator[bytes]:
        for start in range(0, len(body), piece):
            yield body[start : start + piece]

    folder.mkdir(exist_ok=True)
    upload = Upload(folder, max_files=100, max_bytes=10_000_000)
    asyncio.run(receive_upload(stream(), KIND, upload))
    return upload


@pytest.mark.parametrize("piece", [1, 3, 17, 4096, 10_000_000])
def test_files_arrive_whole_in_pieces_of_any_size(tmp_path: Path, piece: int) -> None:
    files = {
        "take/color/000000.png": os.urandom(3000) + f"\r\n--{BOUNDARY[:-1]}\r\n".encode(),
        "take/größe ü.txt": b"",
        "take/手/a;b=c.bin": b"\r\n\r\n--",
    }
    upload = receive(tmp_path / "in", write_body(files, {"options": '{"name": "ä"}'}), piece)
    assert upload.names == list(files)
    assert {name: (tmp_path / "in" / name).read_bytes() for name in files} == files
    assert upload.fields == {"options": '{"name": "ä"}'}
    assert upload.byte_count == sum(map(len, files.values()))


@pytest.mark.parametrize("cut", [1, 5, 40, 2000])
def test_what_is_cut_off_is_refused(tmp_path: Path, cut: int) -> None:
    body = write_body({"a.png": bytes(3000)}, {})
    with pytest.raises(InvalidError, match="middle"):
        receive(tmp_path / "in", body[: -cut - 3])


def test_a_field_that_is_too_long_or_one_too_many_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TooLargeError):
        receive(tmp_path / "a", write_body({}, {"options": "x" * (MAX_FIELD_BYTES + 1)}))
    with pytest.raises(InvalidError, match="16 fields"):
        receive(tmp_path / "b", write_body({}, {f"f{n}": "x" for n in range(17)}))


def test_a_part_of_endless_headers_is_refused(tmp_path: Path) -> None:
    body = f"--{BOUNDARY}\r\n".encode() + b"X: " + b"y" * 1_000_000
    with pytest.raises(InvalidError, match="damaged"):
        receive(tmp_path / "in", body)

"""PNG and JPEG files from outside: their header, whether they are whole, and their pixels."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any, TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.calibration import MAX_PIXELS, MAX_SIDE
from tracker.errors import FrameError, reading

MAX_IMAGE_BYTES = 256 * 1024 * 1024
"""Of one file; a bound of ours."""
COLOR_SUFFIXES = (".png", ".jpg", ".jpeg")
DEPTH_SUFFIXES = (".png",)

_PNG_KINDS = {0: (1, (1, 2, 4, 8, 16)), 2: (3, (8, 16)), 3: (1, (1, 2, 4, 8)), 4: (2, (8, 16)), 6: (4, (8, 16))}
"""Channels and bits that each of PNG's colour types may have: grey, RGB, palette, grey with alpha, RGB with alpha."""


@dataclass(frozen=True)
class ImageHeader:
    """What an image file says it is.

    Attributes:
        kind: `png` or `jpeg`.
        width: px.
        height: px.
        bits: Per channel.
        channels: 1 grey, 2 grey and alpha, 3 colour, 4 colour and alpha.
    """

    kind: str
    width: int
    height: int
    bits: int
    channels: int

    def __str__(self) -> str:
        names = {1: "grey", 2: "grey with alpha", 3: "colour", 4: "colour with alpha"}
        return f"{self.width}x{self.height} {self.bits}-bit {names[self.channels]} {self.kind.upper()}"


Read = TypeVar("Read")


def _reads_image(reader: Callable[..., Read]) -> Callable[..., Read]:
    @wraps(reader)
    def guarded(data: bytes, what: str, **options: Any) -> Read:
        with reading(FrameError, what, "a whole PNG or JPEG image"):
            return reader(data, what, **options)

    return guarded


@_reads_image
def read_header(data: bytes, what: str) -> ImageHeader:
    """Header of an image from its first bytes."""
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        header = _read_png_header(data, what)
    elif data.startswith(b"\xff\xd8\xff"):
        header = _read_jpeg_header(data, what)[0]
    else:
        found = "is empty" if not data else f"begins with {data[:8].hex(' ')}"
        raise FrameError(f"{what}: {found}; needed a PNG or JPEG image.")
    if not (1 <= header.width <= MAX_SIDE and 1 <= header.height <= MAX_SIDE):
        raise FrameError(
            f"{what}: its header says {header.width}x{header.height} px; at most {MAX_SIDE} a side are read."
        )
    if header.width * header.height > MAX_PIXELS:
        raise FrameError(
            f"{what}: its header says {header.width * header.height} pixels; at most {MAX_PIXELS} are read."
        )
    return header


@_reads_image
def check_whole(data: bytes, what: str, *, inflate: bool = False) -> ImageHeader:
    """The file is there to its last byte: every PNG chunk's checksum, or a JPEG's end mark.

    With `inflate`, the packed pixels of a PNG are unpacked and must have exactly the size that the header promises.
    """
    header = read_header(data, what)
    if header.kind == "jpeg":
        _, scan = _read_jpeg_header(data, what)
        if scan < 0 or data.rfind(b"\xff\xd9") < scan:
            raise FrameError(f"{what}: is cut off after {len(data)} bytes (a JPEG without its end). Copy it again.")
        return header
    packed = _walk_png_chunks(data, what)
    if inflate and data[28] == 0:  # Interlaced ones are left to the decoder.
        row = (header.width * header.bits * header.channels + 7) // 8 + 1
        needed = row * header.height
        unpacked = len(zlib.decompressobj().decompress(b"".join(packed), needed + 1))
        if unpacked != needed:
            raise FrameError(f"{what}: holds {unpacked} bytes of pixels where its header promises {needed}.")
    return header


@_reads_image
def decode_color(data: bytes, what: str, *, inflate: bool = False) -> npt.NDArray[np.uint8]:
    """Pixels (H, W, 3) uint8 RGB of a PNG or JPEG; grey becomes RGB, alpha is left out, EXIF rotation is ignored."""
    header = check_whole(data, what, inflate=inflate)
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    if image is None or image.shape != (header.height, header.width, 3) or image.dtype != np.uint8:
        raise FrameError(f"{what}: cannot be decoded ({header}).")
    return cv2.cvtColor(image, cv2.COLOR_BGR2RGB)  # pyright: ignore[reportReturnType]


def check_depth_header(header: ImageHeader, what: str) -> None:
    """A depth image is a 16-bit grey PNG, nothing else."""
    if header.kind != "png" or header.bits != 16 or header.channels != 1:
        hint = ""
        if header.channels >= 3:
            hint = " This is a colour picture (perhaps of depth); export the raw depth."
        elif header.bits == 8:
            hint = " 8 bits cannot hold depth in millimetres; export the raw 16-bit depth."
        raise FrameError(f"{what}: is a {header}; needed a 16-bit grey PNG for depth.{hint}")


@_reads_image
def decode_depth(data: bytes, what: str, *, inflate: bool = False) -> npt.NDArray[np.uint16]:
    """Raw values (H, W) uint16 of a 16-bit grey PNG."""
    check_depth_header(read_header(data, what), what)
    header = check_whole(data, what, inflate=inflate)
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    if image is None or image.shape != (header.height, header.width) or image.dtype != np.uint16:
        raise FrameError(f"{what}: cannot be decoded ({header}).")
    return image  # pyright: ignore[reportReturnType]


def _read_png_header(data: bytes, what: str) -> ImageHeader:
    if len(data) < 33 or data[8:16] != b"\x00\x00\x00\rIHDR":
        raise FrameError(f"{what}: is cut off in its header ({len(data)} bytes). Copy it again.")
    width, height, bits, kind = struct.unpack(">IIBB", data[16:26])
    if zlib.crc32(data[12:29]) != int.from_bytes(data[29:33], "big"):
        raise FrameError(f"{what}: its PNG header is damaged (checksum).")
    if kind not in _PNG_KINDS or bits not in _PNG_KINDS[kind][1]:
        raise FrameError(f"{what}: its PNG header names no known image type ({bits} bits, type {kind}).")
    return ImageHeader("png", width, height, bits, _PNG_KINDS[kind][0])


def _walk_png_chunks(data: bytes, what: str) -> list[bytes]:
    """Packed pixels of a PNG whose chunks are all there and sound."""
    packed, at = [], 8
    while at < len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        end = at + 12 + length
        if end > len(data):
            break
        name = data[at + 4 : at + 8]
        if zlib.crc32(data[at + 4 : end - 4]) != int.from_bytes(data[end - 4 : end], "big"):
            raise FrameError(f"{what}: is damaged at byte {at} (checksum of chunk {name!r}). Copy it again.")
        if name == b"IDAT":
            packed.append(data[at + 8 : end - 4])
        if name == b"IEND":
            if not packed:
                raise FrameError(f"{what}: is a PNG without pixels.")
            return packed
        at = end
    raise FrameError(f"{what}: is cut off after {len(data)} bytes (a PNG without its end). Copy it again.")


def _read_jpeg_header(data: bytes, what: str) -> tuple[ImageHeader, int]:
    """Header and the offset where the first scan begins (-1 when it is not in these bytes)."""
    header, at = None, 2
    while at + 4 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker == 0xFF:
            at += 1
            continue
        length = int.from_bytes(data[at + 2 : at + 4], "big")
        if marker in (0xC0, 0xC1, 0xC2) and at + 10 <= len(data):
            bits, height, width, channels = struct.unpack(">BHHB", data[at + 4 : at + 10])
            if channels not in (1, 3, 4) or bits != 8:
                raise FrameError(
                    f"{what}: is a JPEG of {channels} channels of {bits} bits; needed 8-bit grey or colour."
                )
            header = ImageHeader("jpeg", width, height, bits, channels)
        if marker == 0xDA and header is not None:
            return header, at
        if length < 2:
            break
        at += 2 + length
    if header is None:
        raise FrameError(f"{what}: is cut off or damaged in its JPEG header ({len(data)} bytes). Copy it again.")
    return header, -1

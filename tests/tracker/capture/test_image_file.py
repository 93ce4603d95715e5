"""Image files from outside: cut off, damaged, lying, of the wrong kind."""

from __future__ import annotations

import struct
import zlib

import cv2
import numpy as np
import pytest

from tracker.capture.image_file import check_whole, decode_color, decode_depth, read_header
from tracker.errors import FrameError


def encode(image: np.ndarray, suffix: str = ".png") -> bytes:
    return cv2.imencode(suffix, image)[1].tobytes()


def chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def make_png(width: int, height: int, pixels: bytes, bits: int = 16, kind: int = 0) -> bytes:
    header = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(pixels, 9)) + chunk(b"IEND", b"")
    )


DEPTH = np.random.default_rng(0).integers(0, 4000, (20, 30)).astype(np.uint16)
COLOR = np.random.default_rng(1).integers(0, 256, (20, 30, 3)).astype(np.uint8)


def test_sound_images_are_decoded() -> None:
    np.testing.assert_array_equal(decode_depth(encode(DEPTH), "d", inflate=True), DEPTH)
    np.testing.assert_array_equal(decode_color(encode(COLOR), "c", inflate=True), COLOR[..., ::-1])
    smooth = cv2.resize(COLOR[:3, :3], (30, 20), interpolation=cv2.INTER_CUBIC)
    near = decode_color(encode(smooth, ".jpg"), "j")
    assert np.abs(near.astype(int) - smooth[..., ::-1]).mean() < 10
    grey = decode_color(encode(COLOR[..., 0]), "g")
    np.testing.assert_array_equal(grey, np.repeat(COLOR[..., :1], 3, axis=2))


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_an_image_cut_off_anywhere_is_refused(suffix: str) -> None:
    data = encode(COLOR, suffix)
    for length in range(len(data)):
        with pytest.raises(FrameError, match=r"^x: "):
            decode_color(data[:length], "x")


def test_any_flipped_bit_of_a_png_is_noticed() -> None:
    data = encode(DEPTH)
    for place in range(len(data)):
        damaged = bytearray(data)
        damaged[place] ^= 0x10
        try:
            image = decode_depth(bytes(damaged), "x", inflate=True)
        except FrameError:
            continue
        np.testing.assert_array_equal(image, DEPTH)  # e.g. a bit in a chunk that carries no pixels


@pytest.mark.parametrize(
    ("image", "suffix", "says"),
    [
        (COLOR[..., 0], ".png", "8-bit grey PNG.*raw 16-bit depth"),
        (COLOR, ".png", "colour picture"),
        (COLOR.astype(np.uint16), ".png", "16-bit colour PNG"),
        (COLOR[..., 0], ".jpg", "grey JPEG"),
        (np.dstack([COLOR, COLOR[..., :1]]), ".png", "colour with alpha"),
    ],
)
def test_depth_of_another_kind_is_refused(image: np.ndarray, suffix: str, says: str) -> None:
    with pytest.raises(FrameError, match=says):
        decode_depth(encode(image, suffix), "x")


@pytest.mark.parametrize(
    "data", [b"", b"GIF89a", b"\x00" * 100, b"BM" + b"\x00" * 60, b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"]
)
def test_what_is_no_image_is_refused(data: bytes) -> None:
    with pytest.raises(FrameError, match=r"^x: "):
        decode_color(data, "x")


def test_a_header_that_promises_a_giant_image_is_refused_before_it_is_decoded() -> None:
    with pytest.raises(FrameError, match="at most"):
        decode_depth(make_png(2**31 - 1, 2**31 - 1, b"\0"), "x")
    with pytest.raises(FrameError, match="pixels"):
        decode_depth(make_png(16000, 16000, b"\0"), "x")


def test_pixels_that_do_not_fit_the_header_are_refused() -> None:
    for pixels in (b"\0" * 10, b"\0" * (61 * 20 + 1), b"\0" * 10_000_000):
        with pytest.raises(FrameError, match="header promises 1220"):
            decode_depth(make_png(30, 20, pixels), "x", inflate=True)
    assert decode_depth(make_png(30, 20, b"\0" * (61 * 20)), "x", inflate=True).shape == (20, 30)


def test_a_photograph_keeps_the_size_of_its_header_whatever_its_exif_rotation() -> None:
    exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"
    data = encode(COLOR, ".jpg")
    turned = data[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + data[2:]
    assert decode_color(turned, "x").shape == (20, 30, 3)
    assert (read_header(turned, "x").width, check_whole(turned, "x").height) == (30, 20)

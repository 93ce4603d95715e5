"""Small pictures of an upload: near is bright, far is dark, nothing is black, and none is wider than the page shows."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from server.errors import NotFoundError
from server.imports.pictures import WIDTH, make_picture


def put(folder: Path, name: str, pixels: np.ndarray) -> None:
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    assert cv2.imwrite(str(folder / name), pixels)


def show(folder: Path, name: str) -> np.ndarray:
    """(H, W, 3) BGR, as a browser sees it."""
    data = make_picture(folder, name)
    assert data[:2] == b"\xff\xd8", "a JPEG"
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)


@pytest.mark.parametrize(
    ("size", "shown"),
    [((40, 30), (40, 30)), ((WIDTH, 7), (WIDTH, 7)), ((2 * WIDTH, 100), (WIDTH, 50)), ((20 * WIDTH, 2), (WIDTH, 1))],
)
def test_a_wide_picture_becomes_narrow_in_proportion(
    tmp_path: Path, size: tuple[int, int], shown: tuple[int, int]
) -> None:
    put(tmp_path, "a.png", np.full((size[1], size[0], 3), 90, np.uint8))
    assert show(tmp_path, "a.png").shape[1::-1] == shown


def test_colours_are_those_of_the_image(tmp_path: Path) -> None:
    pixels = np.zeros((32, 64, 3), np.uint8)
    pixels[:, :32], pixels[:, 32:] = (200, 30, 20), (10, 40, 220)
    put(tmp_path, "a.png", pixels)
    found = show(tmp_path, "a.png").astype(int)
    for columns, color in ((slice(0, 24), (200, 30, 20)), (slice(40, 64), (10, 40, 220))):
        assert np.abs(found[:, columns] - color).max() < 12


def test_depth_falls_from_bright_to_dark_and_no_value_is_black(tmp_path: Path) -> None:
    ramp = np.repeat(np.linspace(400, 900, 256)[None], 64, axis=0).astype(np.uint16)
    ramp[:16] = 0
    put(tmp_path, "0.png", ramp)
    gray = cv2.cvtColor(show(tmp_path, "0.png"), cv2.COLOR_BGR2GRAY).astype(float)
    assert gray[:8].max() < 8
    bright = gray[24:].mean(axis=0)[8:-8].reshape(-1, 16).mean(axis=1)
    assert (np.diff(bright) < 0).all() and bright[0] > 4 * bright[-1]


@pytest.mark.parametrize("value", [0, 1, 65535])
def test_depth_of_one_value_is_a_picture_too(tmp_path: Path, value: int) -> None:
    put(tmp_path, "0.png", np.full((16, 16), value, np.uint16))
    found = show(tmp_path, "0.png")
    assert found.std(axis=(0, 1)).max() < 3 and (found.mean() < 3) == (value == 0)


@pytest.mark.parametrize(
    ("name", "said"), [("none.png", "none.png: is not a file of this import"), ("../out.png", "'../out.png'")]
)
def test_a_picture_that_is_not_in_the_upload_is_not_found(tmp_path: Path, name: str, said: str) -> None:
    put(tmp_path, "out.png", np.zeros((4, 4, 3), np.uint8))
    put(tmp_path, "upload/a.png", np.zeros((4, 4, 3), np.uint8))
    with pytest.raises(NotFoundError, match=said):
        make_picture(tmp_path / "upload", name)

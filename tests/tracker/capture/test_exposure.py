"""Dim colour images become as bright as others; all others stay as they are."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.capture.exposure import BRIGHT, DIM, brighten, brighten_frame
from tracker.capture.frame import Frame


def room(brightest: float, size: tuple[int, int] = (240, 320)) -> np.ndarray:
    """(H, W, 3) uint8, of all colours up to some brightness."""
    image = np.random.default_rng(0).uniform(0.0, brightest, (*size, 3))
    image[..., 2] *= 0.5
    return image.astype(np.uint8)


@pytest.mark.parametrize("share", [0.5, 0.35, 0.2])
@pytest.mark.parametrize("size", [(240, 320), (1024, 1280), (9, 8)])
def test_a_dim_image_comes_back_as_bright_as_it_would_have_been(share: float, size: tuple[int, int]) -> None:
    full = room(BRIGHT, size)
    found = brighten((full * share).astype(np.uint8))
    assert np.abs(found.astype(float) - full).mean() < 3.0 / share


@pytest.mark.parametrize("image", [room(250.0), room(DIM * 1.1), np.zeros((48, 64, 3), dtype=np.uint8)])
def test_an_image_that_is_bright_enough_or_black_is_given_back_itself(image: np.ndarray) -> None:
    assert brighten(image) is image


def test_a_dark_infrared_image_is_left_to_the_detector() -> None:
    grey = np.repeat(room(60.0)[..., :1], 3, axis=2)
    assert brighten(grey) is grey


def test_what_is_brightened_once_is_not_again_and_nothing_is_written_into_the_recorded_image() -> None:
    dim = room(50.0)
    before = dim.copy()
    once = brighten(dim)
    assert np.array_equal(dim, before) and brighten(once) is once


def test_a_frame_without_an_image_stays_itself() -> None:
    frame = Frame(0, "cam0", None, np.ones((4, 4)))
    assert brighten_frame(frame) is frame
    dim = brighten_frame(Frame(0, "cam0", room(50.0), None))
    assert dim.color is not None and dim.color.max() > 100 and dim.index == 0

"""Images without colours."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

GREY = 3.0
"""Mean difference of the channels below which an image tells no colours, of 255."""

DARK = 20
"""Pixels darker than this have no colour in any image: where the background was cut out most are."""


def is_grey(image: npt.NDArray[np.uint8]) -> bool:
    """Whether an image (H, W, 3) tells no colours, as an infrared one."""
    red, green, blue = (np.ascontiguousarray(image[::4, ::4, channel]) for channel in range(3))
    brightest = np.maximum(np.maximum(red, green), blue)
    darkest = np.minimum(np.minimum(red, green), blue)
    lit = brightest > DARK
    return not lit.any() or bool(np.mean((brightest - darkest)[lit]) < GREY)

"""Colours of a scan: skin, and green where R17 painted the objects, so that a rule on colours tells them apart."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

GREEN = np.array([38.0, 145.0, 62.0])
PALE, DARK = np.array([232.0, 190.0, 168.0]), np.array([110.0, 72.0, 54.0])


def paint(is_object: npt.NDArray[np.bool_], subject: int, rng: np.random.Generator) -> npt.NDArray[np.uint8]:
    """(N, 3) red, green, blue of points on an object or on skin; G > max(R, 20) holds on objects only ([R17] 3.1)."""
    tone = np.random.default_rng([subject, 77]).uniform()
    skin = tone * PALE + (1.0 - tone) * DARK
    light = rng.normal(1.0, 0.06, len(is_object))[:, None]
    speckle = rng.normal(0.0, 4.0, (len(is_object), 3))
    colors = light * np.where(is_object[:, None], GREEN, skin) + speckle
    return np.clip(np.rint(colors), 0, 255).astype(np.uint8)

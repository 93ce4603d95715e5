"""Labels of a hand that somebody drew: an open hand, as large as one half a metre away looks."""

from __future__ import annotations

import uuid
from typing import Any

import numpy as np
import numpy.typing as npt

from server.quality.hand import EDGES, find_bone_lengths
from server.quality.labels import Label
from server.quality.surroundings import Surroundings
from tracker import Camera

FOCAL_PX, FAR_M = 500.0, 0.5
WIDTH, HEIGHT = 640, 480
K = np.array([[FOCAL_PX, 0.0, 320.0], [0.0, FOCAL_PX, 240.0], [0.0, 0.0, 1.0]])


def draw_hand() -> npt.NDArray[np.float64]:
    """(21, 2) px: fingers spread like a fan, each bone as long as the default hand's, all of it at one depth."""
    lengths, joints = find_bone_lengths(), np.zeros((21, 2))
    for (a, b), length in zip(EDGES, lengths, strict=True):
        finger = (b - 1) // 4
        angle = np.deg2rad(-50.0 + 25.0 * finger)
        joints[b] = joints[a] + length * np.array([np.sin(angle), -np.cos(angle)])
    return joints * FOCAL_PX / FAR_M + np.array([320.0, 400.0])


def label(
    pixels: npt.NDArray[np.float64] | None = None,
    frame: int = 0,
    hand: str = "right",
    depths: Any = FAR_M,
    *,
    is_independent: bool = True,
    camera: str = "cam0",
) -> Label:
    """A label of joints at these pixels; NaN where one is absent. Depths are m, NaN unknown."""
    pixels = draw_hand() if pixels is None else pixels
    is_placed = np.isfinite(pixels).all(axis=1)
    points = np.column_stack([np.where(is_placed[:, None], pixels, 0.0), np.where(is_placed, 2.0, 0.0)])
    around = np.broadcast_to(np.asarray(depths, dtype=np.float64).reshape(-1, 1), (21, 3)).copy()
    none = np.full(21, np.nan)
    return Label(
        *(uuid.uuid4(), 1, camera, frame, hand, points),
        around=Surroundings(around, none, none),
        is_independent=np.full(21, is_independent),
    )


HAND = draw_hand()


def cameras(count: int = 3) -> dict[str, Camera]:
    """In a row, 10 cm apart, all looking straight ahead."""
    found = {}
    for number in range(count):
        T = np.eye(4)
        T[0, 3] = 0.1 * number
        found[f"cam{number}"] = Camera(f"cam{number}", WIDTH, HEIGHT, K, np.zeros(0), T)
    return found


def seen(number: int) -> npt.NDArray[np.float64]:
    """(21, 2) px of the hand in one of them."""
    return HAND - [K[0, 0] * 0.1 * number / FAR_M, 0.0]

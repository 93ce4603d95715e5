"""Free space is only what was seen to be free."""

from __future__ import annotations

import numpy as np

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.observation import Preprocessing, Region, observe

SKIN, TABLE = (200, 140, 115), (40, 90, 120)
CAMERA = Camera("cam0", 160, 120, np.array([[150.0, 0.0, 79.5], [0.0, 150.0, 59.5], [0.0, 0.0, 1.0]]))


def nearest_hand_pixel(column: int, beside: tuple[int, int, int], depth_beside: float) -> int:
    """Column of the nearest pixel that may be hand, of a band of skin (columns 40 to 79) and what is beside it."""
    color = np.full((120, 160, 3), TABLE, dtype=np.uint8)
    depth = np.full((120, 160), 1.5, dtype=np.float32)
    color[:, 40:80], depth[:, 40:80] = SKIN, 0.5
    color[:, 80:110], depth[:, 80:110] = beside, depth_beside
    frame = Frame(0, "cam0", color, depth)
    return int(
        observe(frame, CAMERA, Region(0, 0, 120, 160, 0.3, 0.8), Preprocessing()).nearest_pixel[0, 60, column, 1]
    )


def test_skin_without_depth_beside_a_hand_may_be_hand():
    assert nearest_hand_pixel(90, SKIN, 0.0) == 90


def test_skin_that_was_seen_to_be_far_away_is_not_hand():
    assert nearest_hand_pixel(90, SKIN, 1.5) == 79


def test_a_hole_that_is_not_of_skin_is_not_hand():
    assert nearest_hand_pixel(90, TABLE, 0.0) == 79


def test_a_depth_shadow_is_not_wider_than_a_step_of_ten_centimetres_makes_it():
    assert 90 <= nearest_hand_pixel(108, SKIN, 0.0) <= 96

"""Where in a camera's picture the board was seen, and how well it fits there."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.calibration.camera_calibration import CameraCalibration

Image = npt.NDArray[np.uint8]

PICTURE_WIDTH = 960
"""px."""
CELLS = 8
"""Along the longer side: what is empty is seen at a glance."""

LEVELS = ((0.5, (150, 158, 0)), (1.0, (0, 159, 230)), (2.0, (0, 94, 213)), (np.inf, (40, 0, 150)))
"""Residual, px, up to which a corner has a colour, BGR; told apart by the colour-blind too (Okabe and Ito)."""


def draw_coverage(result: CameraCalibration, number: int) -> Image:
    """The picture (H, W, 3), BGR, of one camera.

    Cells without a corner are grey and struck through; a dot stands for each corner at the moments that were judged,
    coloured by its residual; those that were left out have a ring.
    """
    camera, seen = result.cameras[number], result.residuals.choose(result.residuals.camera == number)
    scale = PICTURE_WIDTH / camera.width
    height, legend = max(round(camera.height * scale), 1), 40
    image = np.full((height + legend, PICTURE_WIDTH, 3), 255, dtype=np.uint8)
    cell = max(PICTURE_WIDTH, height) / CELLS
    places = seen.pixels * scale
    for row in range(int(np.ceil(height / cell))):
        for column in range(int(np.ceil(PICTURE_WIDTH / cell))):
            low = np.array([column, row]) * cell
            count = int(((places >= low) & (places < low + cell)).all(axis=1).sum())
            first = (round(low[0]), round(low[1]))
            last = (min(round(low[0] + cell), PICTURE_WIDTH) - 1, min(round(low[1] + cell), height) - 1)
            if count == 0:
                cv2.rectangle(image, first, last, (232, 232, 232), cv2.FILLED)
                cv2.line(image, first, last, (190, 190, 190), 1, cv2.LINE_AA)
            cv2.rectangle(image, first, last, (215, 215, 215), 1)
    is_left_out = result.is_left_out[seen.moment]
    for place, px, has_ring in zip(places, seen.px, is_left_out, strict=True):
        at = (round(place[0]), round(place[1]))
        color = next(color for level, color in LEVELS if px <= level)
        cv2.circle(image, at, 2, color, cv2.FILLED, cv2.LINE_AA)
        if has_ring:
            cv2.circle(image, at, 5, color, 1, cv2.LINE_AA)
    _draw_legend(image, height, f"{camera.id}: {len(seen.px)} corners")
    return image


def encode_coverage(result: CameraCalibration, number: int) -> bytes:
    """The picture as PNG."""
    return cv2.imencode(".png", draw_coverage(result, number))[1].tobytes()


def _draw_legend(image: Image, top: int, words: str) -> None:
    cv2.line(image, (0, top), (image.shape[1], top), (120, 120, 120), 1)
    x = 10
    for level, color in (*LEVELS, (0.0, (90, 90, 90))):
        text = f"<= {level:g} px" if 0 < level < np.inf else f"> {LEVELS[-2][0]:g} px" if level else "ring: left out"
        cv2.circle(image, (x + 6, top + 20), 5, color, cv2.FILLED if level else 1, cv2.LINE_AA)
        cv2.putText(image, text, (x + 18, top + 25), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (40, 40, 40), 1, cv2.LINE_AA)
        x += 120
    cv2.putText(image, words[:40], (x + 20, top + 25), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (40, 40, 40), 1, cv2.LINE_AA)

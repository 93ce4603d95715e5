"""Colours of errors: blue when small, over yellow, to red when large; the same scale as in the browser app."""

from __future__ import annotations

import numpy as np

ANCHORS = np.array([(62, 118, 208), (98, 170, 200), (226, 205, 120), (232, 122, 74), (214, 48, 49)], dtype=np.float64)
"""RGB at equal steps from no error to the end of the scale; `web/src/model/errorColor.ts` has the same."""


def compute_error_color(value: float) -> tuple[int, int, int]:
    """RGB of an error, 0 (none) to 1 (the scale's end)."""
    at = min(max(float(np.nan_to_num(value, nan=1.0)), 0.0), 1.0) * (len(ANCHORS) - 1)
    below = min(int(at), len(ANCHORS) - 2)
    red, green, blue = np.round(ANCHORS[below] + (ANCHORS[below + 1] - ANCHORS[below]) * (at - below))
    return int(red), int(green), int(blue)

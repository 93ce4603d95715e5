"""How large a scan is, and which unit of length its file may be in: a file does not say."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

UNITS: dict[str, float] = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
"""Metres in the units that files are usually in."""

CERTAIN = ("m", "mm")
"""Units whose hands are of no size that hands in another unit have: these two may be taken without asking."""

HAND_LENGTHS = (0.08, 0.60)
"""m; longest side of a hand: a small fist at least, an arm to the elbow at most."""

LONGEST_SCENE = 3.0
"""m; longest side of a scan that holds other things too, which are cropped before it is registered."""


def measure_size(points: Array) -> Array:
    """(3,) sides of a box that stands along the points (N, 3), the longest first, in their unit; one point in a hundred
    may lie outside of each."""
    centred = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(centred.T @ centred)
    low, high = np.percentile(centred @ axes, [0.5, 99.5], axis=0)
    return np.sort(high - low)[::-1]


def find_possible_units(length: float) -> dict[str, float]:
    """The usual units, by name and in m, in which a longest side of this many units is that of a hand."""
    return {name: metres for name, metres in UNITS.items() if HAND_LENGTHS[0] <= length * metres <= HAND_LENGTHS[1]}


def is_certain(length: float) -> bool:
    """Whether only one usual unit makes a hand of this longest side, and it is metres or millimetres."""
    possible = find_possible_units(length)
    return len(possible) == 1 and not possible.keys().isdisjoint(CERTAIN)


def find_size_fault(length_m: float, longest_m: float = HAND_LENGTHS[1]) -> str | None:
    """What is wrong with a longest side, m, if a hand cannot have it.

    Args:
        length_m: Longest side.
        longest_m: What is allowed: that of a hand, or of a scan that is still to be cropped.
    """
    if HAND_LENGTHS[0] <= length_m <= longest_m:
        return None
    return f"is {write_length(length_m)} long"


def write_length(metres: float) -> str:
    """A length for people, as `18.4 cm`, or in metres or millimetres where that reads better."""
    if metres >= 1.0:
        return f"{metres:.3g} m"
    return f"{100.0 * metres:.3g} cm" if metres >= 0.01 else f"{1e3 * metres:.3g} mm"


SIZES_NEEDED = f"a hand of {100 * HAND_LENGTHS[0]:.0f} to {100 * HAND_LENGTHS[1]:.0f} cm, with its forearm"

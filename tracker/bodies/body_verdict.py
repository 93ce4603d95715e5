"""The verdict on a registration of a person: other things in the scan, or half a person, are reported in words."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

Array = npt.NDArray[np.float64]

FAR_MM, COVERING_MM = 15.0, 25.0
"""A point this far from the surface is not explained; a vertex this far from every point is not covered."""

LIMITS: dict[str, tuple[float, float]] = {"unexplained": (0.005, 0.10), "uncovered": (0.12, 0.25), "shape": (2.5, 4.5)}
"""Beyond the first a registration is doubtful, beyond the second bad; set by eye. Of 17 right ones at most
0.0000, 0.016 and 1.2; a person of whom a part lay 22 mm off left 0.014 of the points unexplained."""


@dataclass(frozen=True)
class BodyVerdict:
    """A judgement.

    Attributes:
        name: "good", "doubtful" or "bad".
        reasons: Why it is not good, in sentences' parts.
        measures: `unexplained`, share of the points far from the surface; `uncovered`, share of the body without
            points, hands left out; `shape`, root mean square of the coefficients, standard deviations.
    """

    name: str
    reasons: tuple[str, ...]
    measures: dict[str, float] = field(default_factory=dict)


def judge_body(
    vertices: Array, is_body: npt.NDArray[np.bool_], points: Array, distances: Array, shape: Array
) -> BodyVerdict:
    """Judge a surface.

    Args:
        vertices: (V, 3) m.
        is_body: (V,) those that are no hands.
        points: (N, 3) of the scan, m.
        distances: (N,) from each to the surface, m.
        shape: (S,) coefficients; none of a person's own template.
    """
    near = KDTree(points[:: max(1, len(points) // 40_000)]).query(vertices[is_body])[0]
    measures = {
        "unexplained": float(np.mean(distances > 1e-3 * FAR_MM)),
        "uncovered": float(np.mean(near > 1e-3 * COVERING_MM)),
        "shape": float(np.sqrt(np.mean(shape**2))) if len(shape) else 0.0,
    }
    said = {
        "unexplained": f"{100 * measures['unexplained']:.1f} % of the points are more than {FAR_MM:.0f} mm from the "
        "body: another person or thing is in the scan, which you can crop, or a part of the body lies in a wrong place",
        "uncovered": f"{100 * measures['uncovered']:.0f} % of the body has no points beside it: the scan shows only "
        "part of a person; needed a whole one",
        "shape": f"the shape lies {measures['shape']:.1f} standard deviations from people's: the scan's unit may be "
        "wrong, or it shows no person",
    }
    worst = max((measures[name] > low) + (measures[name] > high) for name, (low, high) in LIMITS.items())
    reasons = tuple(said[name] for name, (low, _) in LIMITS.items() if measures[name] > low)
    return BodyVerdict(("good", "doubtful", "bad")[worst], reasons, measures)

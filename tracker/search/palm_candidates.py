"""Places of a depth image where a palm could be."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.observation import HAND, Observation

Array = npt.NDArray[np.float64]

MIN_RADIUS, MAX_RADIUS = 0.014, 0.065
"""Radius of the largest disc inside a palm (or a fist) as seen, m; trunks are wider, fingers thinner."""

MAX_STEP = 0.025
"""Neighbouring pixels farther apart in depth belong to different things, m."""

APART = 0.035
"""Candidates keep this distance, m."""


@dataclass(frozen=True)
class PalmCandidate:
    """A place where a palm could be.

    Attributes:
        point: (3,) on the surface, world, m.
        normal: (3,) mean surface normal there, unit, towards the camera, world.
    """

    point: Array
    normal: Array


def find_palm_candidates(observation: Observation, count: int) -> list[PalmCandidate]:
    """At most `count` places, nearest to the camera first, in a sampled whole-image observation.

    The largest disc around a pixel that stays on its surface and within the silhouette is as wide as a palm for palms,
    forearms and faces, so nearness decides the order and a fit decides the rest.
    """
    mask = ((observation.labels & HAND) > 0).astype(np.uint8)
    depth = observation.depth
    nearest = cv2.erode(
        np.where(depth > 0.0, depth, np.float32(100.0)), cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
    )
    inner = np.where(depth - nearest > MAX_STEP, 0, mask)
    distance = cv2.distanceTransform(np.pad(inner, 1), cv2.DIST_L2, 5)[1:-1, 1:-1]
    radius = distance * observation.depth / observation.K[0, 0]
    peaks = (radius >= MIN_RADIUS) & (radius <= MAX_RADIUS) & (distance >= cv2.dilate(distance, np.ones((5, 5))) - 1e-6)
    rows, columns = np.nonzero(peaks)
    order = np.lexsort((columns, rows, observation.depth[rows, columns]))
    candidates: list[PalmCandidate] = []
    for i in order:
        row, column = int(rows[i]), int(columns[i])
        point = observation.points[row, column].astype(np.float64)
        if any(np.linalg.norm(point - other.point) < APART for other in candidates):
            continue
        normal = _mean_normal(observation, row, column, point)
        candidates.append(PalmCandidate(point, normal))
        if len(candidates) == count:
            break
    return candidates


def _mean_normal(observation: Observation, row: int, column: int, point: Array) -> Array:
    reach = int(np.ceil(0.03 * observation.K[0, 0] / observation.depth[row, column]))
    rows = slice(max(0, row - reach), row + reach + 1)
    columns = slice(max(0, column - reach), column + reach + 1)
    near = np.linalg.norm(observation.points[rows, columns] - point, axis=-1) < 0.03
    near &= observation.labels[rows, columns] > 0
    normal = observation.normals[rows, columns][near].astype(np.float64).sum(axis=0)
    length = float(np.linalg.norm(normal))
    if length < 1e-6:
        return -observation.T_world_camera[:3, 2]
    return normal / length

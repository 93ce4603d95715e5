"""Places of a depth image where an object could be."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.observation import HAND, OTHER, Observation

Array = npt.NDArray[np.float64]

MAX_STEP = 0.015
"""Neighbouring pixels farther apart in depth belong to different things, m."""

FEWEST = 12
"""Pixels of the sampled image; smaller regions are noise."""

SIZES = (0.25, 1.5)
"""A region as large as this share of the object may be the object as a whole."""


def find_object_candidates(observation: Observation, size: float, apart: float, hands: Array, count: int) -> Array:
    """(N, 3) at most `count` places on surfaces that may be an object, world, m.

    Pixels that may be no hand are cut into connected regions at depth steps. The middles of regions of the object's
    size come first, then places on all regions, `apart` from each other, those near the hands first: what is tracked
    is handled.

    Args:
        observation: Sampled, of the whole image.
        size: Largest extent of the object, m.
        apart: Distance kept between places, m.
        hands: (H, 3) joints of hands, world, m; may be empty.
        count: Of candidates.
    """
    is_other = (observation.labels & OTHER) > 0
    if (observation.labels & HAND)[is_other].any():  # no colour: all that the hands left over
        is_other &= _is_surface(observation)
    regions = _split(is_other, observation.depth)
    places: list[Array] = []
    for region in range(1, int(regions.max()) + 1):
        points = observation.points[regions == region].astype(np.float64)
        if len(points) < FEWEST:
            regions[regions == region] = 0
            continue
        extent = 2.0 * float(np.percentile(np.linalg.norm(points - points.mean(axis=0), axis=1), 95))
        if SIZES[0] * size <= extent <= SIZES[1] * size:
            middle = points[np.argmin(np.linalg.norm(points - np.median(points, axis=0), axis=1))]
            places.append(middle)
    places.sort(key=lambda place: _cost(place[None], observation, hands)[0])
    rows, columns = np.nonzero(regions)
    points = observation.points[rows, columns].astype(np.float64)
    for i in np.argsort(_cost(points, observation, hands), kind="stable"):
        if len(places) >= count:
            break
        if all(np.linalg.norm(points[i] - place) >= apart for place in places):
            places.append(points[i])
    return np.array(places[:count]).reshape(-1, 3)


def _cost(points: Array, observation: Observation, hands: Array) -> Array:
    """(N,) distance to the nearest hand joint, or without hands to the camera, m."""
    if not len(hands):
        return np.linalg.norm(points - observation.T_world_camera[:3, 3], axis=1)
    return np.min(np.linalg.norm(points[:, None] - hands, axis=2), axis=1)


def _is_surface(observation: Observation) -> npt.NDArray[np.bool_]:
    """(H, W) pixels that lie on some surface: the rims that remain of a hand that was left out do not."""
    is_there = (observation.depth > 0).astype(np.uint8)
    return cv2.morphologyEx(is_there, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)) > 0


def _split(mask: npt.NDArray[np.bool_], depth: npt.NDArray[np.float32]) -> npt.NDArray[np.int32]:
    """(H, W) number of the connected region that a pixel belongs to, 0 for none; pixels behind a depth step are cut."""
    kernel = np.ones((3, 3), np.uint8)
    nearest = cv2.erode(np.where(mask, depth, np.float32(100.0)), kernel)
    inner = mask & (depth - nearest < MAX_STEP)
    return np.asarray(cv2.connectedComponents(inner.astype(np.uint8), connectivity=4)[1], dtype=np.int32)

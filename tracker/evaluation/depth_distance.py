"""A fitted hand against the depth image, where nothing else is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.evaluation.surface_distance import compute_surface_distances
from tracker.fitting.region import region_around
from tracker.fitting.setup import TrackSetup
from tracker.model.joints import HAND_JOINTS
from tracker.observation import HAND, observe

Array = npt.NDArray[np.float64]

BEHIND_WRIST = 0.010
"""Pixels farther than this behind the wrist, along the hand, are the forearm, which the model does not have, m."""


def measure_depth_distances(
    sequence: Sequence, setup: TrackSetup, pose: Array, index: int, max_pixels: int = 2000
) -> Array:
    """Distances (N,), m, from the hand pixels of a depth image to the surface of the hands fitted to it.

    Hand pixels are those of the raw depth image near the hands that have the colour of skin, where there is colour, and
    that lie ahead of the wrist of the hand whose palm is nearest. At most `max_pixels`, evenly chosen.

    Args:
        sequence: The recording.
        setup: Models and camera of the track.
        pose: (D,) the frame's.
        index: The frame.
        max_pixels: More are not needed for a median.
    """
    posed = setup.scene.pose_at(np.asarray(pose, dtype=np.float64))
    frame, camera = setup.read(sequence, index)
    region = region_around(posed.vertices, camera)
    if region is None:
        return np.zeros(0)
    seen = observe(frame, camera, region, replace(setup.preprocessing, bilateral_diameter=0))
    points = seen.points[(seen.labels & HAND) > 0].astype(np.float64)
    hands = [number for number, model in enumerate(setup.models) if model.hand]
    points = points[_ahead_of_wrists(points, [posed.landmarks(number) for number in hands])]
    if len(points) > max_pixels:
        points = points[np.linspace(0, len(points) - 1, max_pixels).astype(int)]
    if len(points) == 0:
        return np.zeros(0)
    is_hand_face = np.isin(setup.scene.face_models, hands)
    return compute_surface_distances(points, posed.vertices, setup.scene.arrays.faces[is_hand_face])


def _ahead_of_wrists(points: Array, hands: list[Array]) -> npt.NDArray[np.bool_]:
    """(N,) whether each point is ahead of the wrist of the hand (21, 3) whose middle knuckle is nearest."""
    knuckle = HAND_JOINTS.index("middle_mcp")
    nearest = np.argmin([np.linalg.norm(points - joints[knuckle], axis=1) for joints in hands], axis=0)
    wrists = np.array([joints[0] for joints in hands])
    forward = np.array([joints[knuckle] - joints[0] for joints in hands])
    forward /= np.maximum(np.linalg.norm(forward, axis=1, keepdims=True), 1e-9)
    along = np.einsum("ni,ni->n", points - wrists[nearest], forward[nearest])
    return along > -BEHIND_WRIST

"""Look for hands that are lost: near their last place, then in the whole image."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.attempt import Attempt, attempt_fit, look
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.region import depth_range, whole_image
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.observation import HAND, observe
from tracker.search.leave_out import leave_out
from tracker.search.part import Part
from tracker.search.seen_hands import place_where_seen
from tracker.search.start_automatic import STEP, Found, find_hand
from tracker.search.tools import Tools

Array = npt.NDArray[np.float64]

COARSE = 4
"""Step in px of the pixels that are examined for anything left to search."""

STEPS = 8
"""Frames that share a search of the whole image."""

MIN_AREA = 1e-3
"""Less hand than this, m², is left over by an outline or shows a fingertip, not a hand."""


def find_seen(
    sightings: Sightings, setup: TrackSetup, tools: Tools, pose: Array, lost: tuple[int, ...]
) -> tuple[Attempt, tuple[int, ...]] | None:
    """As `find_again`, of those lost hands that the detector sees, where it sees them."""
    there = [index for index in lost if setup.names[index] in sightings.hands]
    if not there:
        return None
    start = place_where_seen(setup, pose, there, sightings)
    still = tuple(index for index in lost if index not in there)
    attempt = _settle(sightings, setup, tools, start, still)
    if attempt is None or set(attempt.gone) & set(there):
        return None
    return attempt, still


def find_again(
    sightings: Sightings, setup: TrackSetup, tools: Tools, pose: Array, lost: tuple[int, ...], step: int
) -> tuple[Attempt, tuple[int, ...]] | None:
    """The scene with lost hands where they were found, and the hands still lost; None if none was found.

    A frame has time for a part of all places and directions only; STEPS frames that follow each other try all of them.

    Args:
        sightings: The frame, undistorted, and what the detector sees in it.
        setup: Models and options.
        tools: Of the run.
        pose: (D,) of the other models; of the lost hands where they were last.
        lost: Indices of the hands.
        step: Which part, any number.
    """
    frame, camera = sightings.frame, sightings.camera
    if not _is_hand_left(frame, camera, setup, pose, lost):
        return None
    near_by = _settle(sightings, setup, tools, pose, ())
    if near_by is not None and not near_by.lost:
        return near_by, ()
    found_pose, missing = _search(frame, camera, setup, pose, lost, step)
    for still in dict.fromkeys((missing, *((*missing, index) for index in lost if index not in missing))):
        if len(still) == len(lost):
            break
        attempt = _settle(sightings, setup, tools, found_pose, still)
        if attempt is not None and not attempt.gone:
            return attempt, still
    return None


def _is_hand_left(frame: Frame, camera: Camera, setup: TrackSetup, pose: Array, lost: tuple[int, ...]) -> bool:
    """Whether the other models leave enough hand pixels for one of those that are lost."""
    others = [index for index in range(len(setup.models)) if index not in lost]
    rest = leave_out(frame, camera, setup.scene, pose, others)
    how = replace(setup.preprocessing, bilateral_diameter=0, objects=False)
    seen = observe(rest, camera, whole_image(camera, *depth_range(frame)), how, COARSE)
    depths = seen.depth[(seen.labels & HAND) > 0].astype(np.float64)
    return float(np.sum(depths**2)) / (seen.K[0, 0] * seen.K[1, 1]) > MIN_AREA


def _search(
    frame: Frame, camera: Camera, setup: TrackSetup, pose: Array, lost: tuple[int, ...], step: int
) -> tuple[Array, tuple[int, ...]]:
    """The pose with hands where a search of the whole image puts them, and those of which there is no trace.

    The hand that is found best comes first; what it explains is not looked at again.
    """
    near, far = depth_range(frame)
    part = slice(step % STEPS, None, STEPS)
    pose, missing = pose.copy(), list(lost)
    while missing:
        others = [index for index in range(len(setup.models)) if index not in missing]
        rest = leave_out(frame, camera, setup.scene, pose, others)
        candidates: dict[int, Found] = {}
        for index in missing:
            found = find_hand(rest, camera, setup.models[index], setup.preprocessing, near, far, STEP, part)
            if found is not None and found.quality.agrees:
                candidates[index] = found
        if not candidates:
            break
        best = max(candidates, key=lambda index: candidates[index].quality.merit)
        pose[setup.scene.pose_slices[best]] = candidates[best].pose
        missing.remove(best)
    return pose, tuple(missing)


def _settle(
    sightings: Sightings, setup: TrackSetup, tools: Tools, pose: Array, missing: tuple[int, ...]
) -> Attempt | None:
    """Fit the scene without the missing hands from a pose (D,)."""
    part = Part.without(setup, missing)
    start = part.take(pose)
    seen = look(sightings.frame, sightings.camera, part.setup, start)
    if seen is None:
        return None
    options = FitOptions(iterations=setup.options.iterations)
    objective = sightings.add_to(tools.objective, part.setup.scene, part.setup.names)
    attempt = attempt_fit(part.setup, seen, start, start, objective, options, sightings)
    return part.widen(attempt, pose)

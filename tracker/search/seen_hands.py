"""Hands where the detector saw them: fits that start there, and how well a fit agrees with what was seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.attempt import MIN_PIXELS, UNSETTLED, Attempt, attempt_fit, look
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.quality import BROAD_MISFIT, Quality
from tracker.fitting.region import region_around_joints
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sighting, Sightings
from tracker.observation import Observation, observe
from tracker.search.start_annotated import start_hand

Array = npt.NDArray[np.float64]

DESCENT = 14
"""Steps from the detected joints to a pose, before the depth has its say."""

POLISH = 5
"""Iterations at last without the joints: where nothing covers the hand its depth knows better where a finger is."""

AGREES = 0.4
"""A fit whose joints are this near to the detected ones, `Quality.apart`, needs no other start."""

FINGER_AGREES = 0.6
"""Neither does one whose worst finger is, `Quality.worst_finger`."""

MARGIN = 0.08
"""Room around detected joints, m."""

REACH = 0.20
"""Depth before and behind the hand, m."""


def try_where_seen(
    setup: TrackSetup, sightings: Sightings, best: Attempt, objective: Objective, options: FitOptions
) -> Attempt:
    """The attempt, or a better one with the joints that the detector saw, where the attempt leaves a doubt.

    A hand that the depth image settles needs no joints from a detector: they are wrong by some pixels. Where there is a
    doubt, the fit goes on with them from where it is, and if that does not help, from where they are.
    """
    doubtful = find_doubtful(best)
    if not doubtful:
        return best
    guided = sightings.add_to(objective, setup.scene, setup.names)
    for start in (best.pose, place_where_seen(setup, best.pose, doubtful, sightings)):
        seen = look(sightings.frame, sightings.camera, setup, start)
        if seen is None:
            continue
        other = attempt_fit(setup, seen, start, start, guided, options, sightings)
        free = attempt_fit(
            setup, seen, other.pose, other.pose, objective, replace(options, iterations=POLISH), sightings
        )
        best = max((best, other, free), key=lambda attempt: attempt.worth)
        if not find_doubtful(best):
            break
    return best


def _is_doubtful(quality: Quality) -> bool:
    """Whether the depth image shows a good part of a finger elsewhere, or the detector saw one that it does not settle.

    Where it settles the hand the detector has no say: in twin 17 two drawn hands around a pipe are seen 0.8 quarters of
    a palm off with no misfit at all, and fits with those joints cost 1 px in each of 140 frames.
    """
    assert quality.apart is not None and quality.worst_finger is not None
    is_elsewhere = quality.worst_finger > FINGER_AGREES or quality.apart > AGREES
    return (is_elsewhere and quality.misfit > UNSETTLED) or quality.broad_misfit > 0.5 * BROAD_MISFIT


def find_doubtful(attempt: Attempt) -> list[int]:
    """Hands that were seen elsewhere, or that the depth image does not settle."""
    return [
        index for index, quality in attempt.qualities.items() if quality.apart is not None and _is_doubtful(quality)
    ]


def place_where_seen(setup: TrackSetup, pose: Array, hands: list[int], sightings: Sightings) -> Array:
    """The pose (D,) with some hands (indices) where the detector saw them."""
    pose = pose.copy()
    for index in hands:
        sighting = sightings.hands[setup.names[index]]
        seen = _look_at(sighting, sightings.frame, sightings.camera, setup)
        pose[setup.scene.pose_slices[index]] = start_hand(
            setup.models[index], sighting.points, sightings.camera, seen, DESCENT, sighting.hand.points_3d[:, 2]
        )
    return pose


def _look_at(sighting: Sighting, frame: Frame, camera: Camera, setup: TrackSetup) -> Observation | None:
    """What is seen around detected joints; None where too little is."""
    assert frame.depth is not None
    points = sighting.hand.points
    region = region_around_joints(points, points, frame.depth, camera, MARGIN, REACH)
    if region is None:
        return None
    seen = observe(frame, camera, region, setup.preprocessing)
    return seen if seen.hand_count >= MIN_PIXELS else None

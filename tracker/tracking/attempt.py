"""Fit one frame, judge the fit, and try otherwise where it is bad."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.observation import Observation, observe
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.model_to_data import ModelToData
from tracker.tracking.depth_range import depth_range
from tracker.tracking.finger_search import search_fingers
from tracker.tracking.frame_fit import Fit, FitOptions, draw, fit_frame
from tracker.tracking.leave_out import leave_out
from tracker.tracking.object_quality import ObjectQuality, measure_object_quality
from tracker.tracking.objective import Objective
from tracker.tracking.quality import Quality, measure_quality
from tracker.tracking.region import region_around
from tracker.tracking.setup import TrackSetup
from tracker.tracking.start_automatic import find_hand
from tracker.tracking.tools import Tools

Array = npt.NDArray[np.float64]

MIN_PIXELS = 60
"""Fewer hand pixels than this near the expected place mean that the hand is gone."""

SCORED_PIXELS = 1500
"""About so many hand pixels are enough to compare bends of a finger by."""

WIDE = {
    "model_to_data": ModelToData(max_distance=0.025, max_angle=60.0),
    "data_to_surface": DataToSurface(max_distance=0.025),
}
"""Terms with longer reach, for the second try."""


@dataclass(frozen=True)
class Attempt:
    """A fitted pose and how well it explains each hand, and each object, of the scene."""

    pose: Array
    qualities: dict[int, Quality]
    fit: Fit
    objects: dict[int, ObjectQuality]

    @property
    def quality(self) -> Quality:
        """Of the hand that is worst explained."""
        return min(self.qualities.values(), key=lambda quality: quality.score)


def try_again(
    setup: TrackSetup, seen: Observation, start: Array, objective: Objective, guided: Objective, options: FitOptions
) -> Attempt:
    """A search of single fingers, a fit with longer reach and `guided` by fingertips, and the usual fit from there."""
    scene, pose = setup.scene, start
    thin = seen.thin(max(1, round((seen.hand_count / SCORED_PIXELS) ** 0.5)))
    for index, (model, where) in enumerate(zip(setup.models, scene.pose_slices, strict=True)):
        if model.hand:

            def score(trial: Array, index: int = index) -> float:
                return measure_quality(draw(scene.pose_at(trial), thin), thin, index).score

            pose = search_fingers(pose, where.start, model, score)
    wide = replace(guided, terms={**guided.terms, **WIDE})
    far = FitOptions(iterations=options.iterations, damping=1e-2, max_turn=0.25, max_shift=0.02)
    pose = fit_frame(scene, seen, pose, pose, wide, far).pose
    return attempt_fit(setup, seen, pose, pose, objective, options)


def attempt_fit(
    setup: TrackSetup, seen: Observation, start: Array, previous: Array, objective: Objective, options: FitOptions
) -> Attempt:
    fit = fit_frame(setup.scene, seen, start, previous, objective, options)
    view = draw(setup.scene.pose_at(fit.pose), seen)
    hands = [index for index, model in enumerate(setup.models) if model.hand]
    objects = {i: measure_object_quality(view, seen, i) for i in range(len(setup.models)) if i not in hands}
    return Attempt(fit.pose, {index: measure_quality(view, seen, index) for index in hands}, fit, objects)


def look(frame: Frame, camera: Camera, setup: TrackSetup, pose: Array) -> Observation | None:
    region = region_around(setup.scene.pose_at(pose).vertices, camera)
    if region is None:
        return None
    seen = observe(frame, camera, region, setup.preprocessing)
    return seen if seen.hand_count >= MIN_PIXELS else None


def find_again(
    frame: Frame, camera: Camera, setup: TrackSetup, tools: Tools, last: Array, attempt: Attempt | None
) -> Attempt | None:
    """Look for every hand that is lost, or failing that for the worst, in what the rest of the scene leaves over."""
    near, far = depth_range(frame)
    pose = (last if attempt is None else attempt.pose).copy()
    hands = [index for index, model in enumerate(setup.models) if model.hand]
    qualities = {} if attempt is None else attempt.qualities
    wanted = [index for index in hands if index not in qualities or qualities[index].is_lost]
    kept = [index for index in range(len(setup.models)) if index not in wanted]
    for index in wanted or [min(hands, key=lambda hand: qualities[hand].score)]:
        others = [other for other in kept if other != index]
        rest = leave_out(frame, camera, setup.scene, pose, others)
        found = find_hand(rest, camera, setup.models[index], setup.preprocessing, near, far)
        if found is None or found.quality.is_lost:
            return None
        pose[setup.scene.pose_slices[index]] = found.pose
        kept.append(index)
    seen = look(frame, camera, setup, pose)
    if seen is None:
        return None
    again = attempt_fit(setup, seen, pose, pose, tools.objective, FitOptions(iterations=setup.options.iterations))
    return None if again.quality.is_lost else again

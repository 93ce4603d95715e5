"""Fit one frame, judge the fit, and try otherwise where it is bad."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.finger_search import search_fingers, swap_fingers
from tracker.fitting.frame_fit import Fit, FitOptions, draw, fit_frame
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.object_quality import ObjectQuality, measure_object_quality
from tracker.fitting.objective import Objective
from tracker.fitting.quality import Quality
from tracker.fitting.region import choose_stride, region_around
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.observation import Observation, observe
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.joint_prior import Regularization
from tracker.terms.model_to_data import ModelToData

Array = npt.NDArray[np.float64]

MIN_PIXELS = 60
"""Fewer hand pixels than this near the expected place mean that the hand is gone."""

FINGER_ROUNDS = 2
"""Searches of single fingers, each with fits after it; a finger that is in another's place must wait for that one."""

SCORED_PIXELS = 1500
"""About this many hand pixels are enough to compare bends of a finger."""

FAR_REACH, WIDE_REACH = 0.040, 0.025
"""Greatest distance of a correspondence, m: where a hand's place is in doubt, and where only its fingers are."""

UNSETTLED = 1.2e-5
"""A misfit above this area, m², is worth another try: where a hand is followed with its own model there is none."""

MISFIT_LOSS = 1000.0
"""Worth lost per m² of misfit: a finger on another's place may agree with more pixels and leave its own."""

DISTANCE_LOSS = 0.5
"""Worth lost by a hand none of whose joints is where the detector saw it, half of it by its worst finger."""

LOST_LOSS = 0.1
"""Worth lost by a hand that should not be believed. With 0 a sixth of the frames of `d405_take001` that show the hand
whole are lost, with this a tenth; if it weighed more than all else a twentieth, but of the 8 marked frames 2 instead of
1 would then be called `ok` with a fingertip in a wrong place."""


@dataclass(frozen=True)
class Attempt:
    """A fitted pose and how well it explains each hand, and each object, of the scene.

    Attributes:
        pose: (D,).
        qualities: Of each hand.
        fit: How it came about.
        objects: Quality of each object.
    """

    pose: Array
    qualities: dict[int, Quality]
    fit: Fit
    objects: dict[int, ObjectQuality]

    @property
    def worst(self) -> int:
        """The hand that is worst explained."""
        return min(self.qualities, key=lambda hand: (not self.qualities[hand].is_lost, self.qualities[hand].score))

    @property
    def quality(self) -> Quality:
        """Of the hand that is worst explained."""
        return self.qualities[self.worst]

    @property
    def gone(self) -> tuple[int, ...]:
        """Hands that are not in their place."""
        return tuple(hand for hand, quality in self.qualities.items() if quality.is_gone)

    @property
    def lost(self) -> tuple[int, ...]:
        """Hands that should not be believed: those, and those of which some finger is elsewhere."""
        return tuple(hand for hand, quality in self.qualities.items() if quality.is_lost)

    @property
    def agreement(self) -> float:
        """How well all hands agree with the depth image: their score, less for misfit."""
        return sum(quality.score - MISFIT_LOSS * quality.misfit for quality in self.qualities.values())

    @property
    def worth(self) -> float:
        """To compare attempts by: their agreement, less for joints seen elsewhere and for what is lost."""
        return self.agreement - sum(
            0.5 * DISTANCE_LOSS * ((quality.apart or 0.0) + (quality.worst_finger or 0.0)) + LOST_LOSS * quality.is_lost
            for quality in self.qualities.values()
        )

    @property
    def misfit(self) -> float:
        """Of the hand that has most, m²."""
        return max(quality.misfit for quality in self.qualities.values())


def try_again(
    setup: TrackSetup,
    seen: Observation,
    start: Array,
    objective: Objective,
    guided: Objective,
    options: FitOptions,
    sightings: Sightings | None = None,
) -> Attempt:
    """Fits with longer reach, stiff and then with fingers; if that leaves something, other places of fingers.

    Args:
        setup: Models and options.
        seen: The frame.
        start: (D,) pose to start from.
        objective: For the last fit.
        guided: The same with the frame's fingertips, for the fits with longer reach.
        options: Of the last fit.
        sightings: What the hand detector saw, to judge by.
    """
    far = FitOptions(iterations=options.iterations, damping=1e-2, max_turn=0.25, max_shift=0.02)
    stiff = replace(_reaching(guided, FAR_REACH), regularization=Regularization(2.0))
    pose = fit_frame(setup.scene, seen, start, start, stiff, far).pose
    pose = fit_frame(setup.scene, seen, pose, pose, _reaching(guided, FAR_REACH), far).pose
    best = attempt_fit(setup, seen, pose, pose, objective, options, sightings)
    wide = _reaching(guided, WIDE_REACH)

    def try_from(pose: Array) -> Attempt:
        pose = fit_frame(setup.scene, seen, pose, pose, wide, far).pose
        other = attempt_fit(setup, seen, pose, pose, objective, options, sightings)
        return other if other.worth > best.worth else best

    for _ in range(FINGER_ROUNDS):
        before = best
        for pose in _swap_fingers(setup, before):
            best = try_from(pose)
        if best.misfit > UNSETTLED:
            best = try_from(_bend_fingers(setup, seen, best.pose))
        if best.misfit < UNSETTLED or best is before:
            break
    return best


def _swap_fingers(setup: TrackSetup, attempt: Attempt) -> list[Array]:
    """Poses (D,) with two neighbouring fingers swapped, of hands that leave something."""
    poses = []
    for index, quality in attempt.qualities.items():
        if quality.misfit > UNSETTLED:
            first_dof = setup.scene.pose_slices[index].start
            poses += swap_fingers(attempt.pose, first_dof, setup.models[index])
    return poses


def _reaching(objective: Objective, reach: float) -> Objective:
    """The objective with correspondences as far as `reach`, m."""
    wide = {
        "model_to_data": ModelToData(max_distance=reach, max_angle=60.0),
        "data_to_surface": DataToSurface(max_distance=reach),
    }
    return replace(objective, terms={**objective.terms, **wide})


def _bend_fingers(setup: TrackSetup, seen: Observation, pose: Array) -> Array:
    """The pose with every finger in turn at the best of a few bends."""
    scene = setup.scene
    thin = seen.thin_to(SCORED_PIXELS)
    for hand in setup.hands:

        def score(trial: Array, hand: int = hand) -> float:
            return measure_quality(draw(scene.pose_at(trial), thin), thin, hand).score

        pose = search_fingers(pose, scene.pose_slices[hand].start, setup.models[hand], score)
    return pose


def attempt_fit(
    setup: TrackSetup,
    seen: Observation,
    start: Array,
    previous: Array,
    objective: Objective,
    options: FitOptions,
    sightings: Sightings | None = None,
) -> Attempt:
    """Fit a scene from a pose (D,), and judge each hand and each object; hands also by where the detector saw them."""
    fit = fit_frame(setup.scene, seen, start, previous, objective, options)
    view = draw(setup.scene.pose_at(fit.pose), seen)
    objects = {index: measure_object_quality(view, seen, index) for index in setup.objects}
    qualities = {index: measure_quality(view, seen, index) for index in setup.hands}
    if sightings is not None:
        for index in setup.hands:
            if setup.names[index] in sightings.hands:
                joints = sightings.camera.project(view.posed.landmarks(index))
                sighting = sightings.hands[setup.names[index]]
                apart, worst = sighting.measure(joints)
                qualities[index] = replace(qualities[index], apart=apart, worst_finger=worst, is_led=sighting.is_led)
    return Attempt(fit.pose, qualities, fit, objects)


def look(
    frame: Frame, camera: Camera, setup: TrackSetup, pose: Array, min_pixels: int = MIN_PIXELS
) -> Observation | None:
    """What is seen around a pose (D,); None where it is out of sight or too few hand pixels are."""
    region = region_around(setup.scene.pose_at(pose).vertices, camera)
    if region is None:
        return None
    seen = observe(frame, camera, region, setup.preprocessing, choose_stride(region, camera))
    return seen if seen.hand_count >= min_pixels else None

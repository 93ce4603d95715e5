"""[T16] as the paper has it: Algorithm 1 for every frame, and nothing else.

Correspondences of every term and one Gauss-Newton step take turns, ten times. No second try, no search, no term and no
thinning of ours (`docs/objective.md` lists what of a term itself differs, such as the cones of the collision term).

Differs from the paper: a frame starts where the roots would be if they went on as before, and not at the pose of the
frame before. At 30 frames a second that changes nothing; every third frame of a waving hand is lost without it.
"""

from __future__ import annotations

from collections.abc import Mapping
from time import perf_counter

import numpy as np

from tracker.capture.sequence import Sequence
from tracker.detection import find_fingertips
from tracker.fitting.attempt import MIN_PIXELS, attempt_fit
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.region import region_around
from tracker.fitting.setup import TrackSetup
from tracker.observation import Observation, observe
from tracker.search.tools import Tools
from tracker.terms.collision import Collision
from tracker.terms.data_to_model import DataToModel
from tracker.terms.joint_prior import Bending
from tracker.terms.model_to_data import ModelToData
from tracker.terms.physics import Supported
from tracker.terms.residual import Term
from tracker.terms.salient import Salient
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.state import TrackState
from tracker.tracking.watch_objects import watch_objects

COLLISION_WEIGHT = 10.0
"""γ_c (§4.1.3)."""

SALIENT_REJECTION = 0.012
"""λ = 1.2 (§4.1.2) in centimetres (`terms/salient.py` says why), m; with w_s = 1."""

PHYSICS_WEIGHT = 10.0
"""γ_ph (§4.2.1)."""

PIXELS_OF_30_MM = 40
"""px; more than the 30 mm of §3.2.3 are half a metre from the camera, so that only those limit contours."""

CONTOURS = DataToModel(weight=1.0, max_pixels=PIXELS_OF_30_MM, stride=1, at_vertices=True)

DATA_TERMS: dict[str, Term] = {"model_to_data": ModelToData(), "data_to_model": CONTOURS}
"""Eq. 7 and Eq. 8: each with the weight of one that Eq. 5 gives it, and all matches."""


def follow_as_written(
    sequence: Sequence,
    setup: TrackSetup,
    tools: Tools,
    state: TrackState,
    data_terms: Mapping[str, Term] = DATA_TERMS,
) -> tuple[TrackState, FrameResult]:
    """The next frame; a hand that the fit does not explain is called lost and followed on from where it is.

    Args:
        sequence: The recording.
        setup: Models and options.
        tools: With what S and P need.
        state: After the frame before.
        data_terms: Eq. 7 and Eq. 8; studies change them.
    """
    read_at = perf_counter()
    frame, camera = setup.read(sequence, state.next_frame)
    started = perf_counter()
    stages = {"reading": started - read_at}
    predicted = state.predict(setup.scene)
    region = region_around(setup.scene.pose_at(predicted).vertices, camera)
    seen = None if region is None else observe(frame, camera, region, setup.preprocessing)
    stages["observing"] = perf_counter() - started
    attempt, pose = None, state.pose
    if seen is not None and seen.hand_count >= MIN_PIXELS:
        is_first = state.next_frame == setup.options.first_frame
        iterations = setup.options.first_iterations if is_first else setup.options.iterations
        options = FitOptions(iterations=iterations, stop_below=0.001 * setup.options.stop_below_mm, fine=iterations)
        objective = compose_objective(setup, tools, seen, data_terms)
        attempt = attempt_fit(setup, seen, predicted, state.pose, objective, options)
        stages |= attempt.fit.stages
        pose = attempt.pose if np.all(np.isfinite(attempt.pose)) else state.pose
    _, objects = watch_objects(frame, camera, setup, pose, None if attempt is None else attempt.objects, recover=False)
    lost = setup.hands if attempt is None else attempt.lost
    hand_status = tuple("lost" if hand in lost else "ok" for hand in setup.hands)
    seconds = perf_counter() - started
    result = FrameResult.of(state.next_frame, pose, hand_status, seconds, attempt, stages, objects)
    return TrackState(state.next_frame + 1, pose, state.pose), result


def compose_objective(
    setup: TrackSetup, tools: Tools, seen: Observation, data_terms: Mapping[str, Term] = DATA_TERMS
) -> Objective:
    """Eq. 5 for a frame, with the terms that the run's letters ask for."""
    terms: dict[str, Term] = dict(data_terms)
    if "C" in setup.options.term_letters:
        terms["collision"] = Collision(weight=COLLISION_WEIGHT)
    if tools.detector is not None:
        terms["salient"] = Salient(find_fingertips(tools.detector, seen), rejection=SALIENT_REJECTION)
    if tools.world is not None:
        terms["physics"] = Supported(tools.world, PHYSICS_WEIGHT)
    return Objective(terms=terms, bending=Bending(weight=0.0))

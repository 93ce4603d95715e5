"""Go from frame to frame: predict, fit, judge, and look for what was lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.sequence import Sequence
from tracker.observation import Observation, observe
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.model_to_data import ModelToData
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.depth_range import depth_range
from tracker.tracking.finger_search import search_fingers
from tracker.tracking.frame_fit import Fit, FitOptions, draw, fit_frame
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.leave_out import leave_out
from tracker.tracking.objective import Objective
from tracker.tracking.quality import Quality, measure_quality
from tracker.tracking.region import region_around
from tracker.tracking.setup import TrackSetup
from tracker.tracking.start_automatic import find_hand
from tracker.tracking.state import TrackState

Array = npt.NDArray[np.float64]

MIN_PIXELS = 60
"""Fewer hand pixels than this near the expected place mean that the hand is gone."""

SCORE_DROP = 0.10
"""A score this far below the running one calls for a second try."""

UNEXPLAINED = 0.15
"""So does this share of hand pixels that the model does not explain: a finger may be hidden in the palm."""

SCORED_PIXELS = 1500
"""About so many hand pixels are enough to compare bends of a finger by."""

SCORE_GAIN = 0.02
"""A search was worth it if it raised the score by this."""

DOUBTFUL = 0.25
"""With this share of hand pixels unexplained the whole image is searched, now and then."""

FINGER_REST = 4
"""Frames to wait after a search of fingers in vain."""

FIRST_IMAGE_REST, LAST_IMAGE_REST = 15, 120
"""Frames to wait after a search of the image in vain: the first time, and at most; the wait doubles each time."""

SCORE_MEMORY = 0.9
"""Share of the running score kept from frame to frame."""

WIDE = {
    "model_to_data": ModelToData(max_distance=0.025, max_angle=60.0),
    "data_to_surface": DataToSurface(max_distance=0.025),
}
"""Terms with longer reach, for the second try."""


@dataclass(frozen=True)
class _Attempt:
    """A fitted pose and how well it explains each hand of the scene."""

    pose: Array
    qualities: dict[int, Quality]
    fit: Fit

    @property
    def quality(self) -> Quality:
        """Of the hand that is worst explained."""
        return min(self.qualities.values(), key=lambda quality: quality.score)


def track_frames(
    sequence: Sequence,
    setup: TrackSetup,
    state: TrackState,
    frames: range,
    on_frame: Callable[[int, FrameResult], None] | None = None,
) -> tuple[TrackState, TrackChunk]:
    """Track consecutive frames; the same state and frames give the same result to the last bit, times apart.

    Args:
        sequence: The recording.
        setup: Models and options.
        state: After the frame before `frames`.
        frames: The first must be `state.next_frame`.
        on_frame: Called after every frame; an exception from it ends the run there.
    """
    assert not len(frames) or frames[0] == state.next_frame, "chunks are tracked in order"
    cv2.setNumThreads(setup.options.threads)
    results = []
    for index in frames:
        state, result = follow_frame(sequence, setup, state, recover=setup.options.recover)
        results.append(result)
        if on_frame:
            on_frame(index, result)
    return state, TrackChunk.of(results)


def follow_frame(
    sequence: Sequence, setup: TrackSetup, state: TrackState, recover: bool
) -> tuple[TrackState, FrameResult]:
    """Track the next frame."""
    read_at = perf_counter()
    frame, camera = setup.read(sequence, state.next_frame)
    started = perf_counter()
    attempt, rest, stages = _follow(frame, camera, setup, state)
    status = "ok"
    if attempt is None or attempt.quality.is_lost:
        found = _find_again(frame, camera, setup, state, attempt) if recover else None
        attempt, status = (found, "recovered") if found else (attempt, "lost")
    elif recover and rest[1] == 0 and _is_doubtful(attempt.quality, state):
        searched_at = perf_counter()
        found = _find_again(frame, camera, setup, state, attempt)
        is_better = found is not None and found.quality.merit > attempt.quality.merit + SCORE_GAIN
        attempt, status = (found, "recovered") if found and is_better else (attempt, "ok")
        longer = 0 if is_better else min(max(FIRST_IMAGE_REST, 2 * rest[2]), LAST_IMAGE_REST)
        rest = (rest[0], longer, longer)
        stages["searching the image"] = perf_counter() - searched_at
    seconds = perf_counter() - started
    stages["reading"] = started - read_at
    is_followed = status == "ok" and not state.is_lost
    is_lost = status == "lost" or attempt is None
    pose = state.pose if is_lost or attempt is None else attempt.pose
    next_state = TrackState(
        state.next_frame + 1,
        pose,
        state.pose if is_followed else pose,
        _running_score(state, attempt, status),
        is_lost,
        rest,
    )
    return next_state, FrameResult(
        state.next_frame,
        pose,
        status,
        seconds,
        None if attempt is None else attempt.quality,
        () if attempt is None else attempt.fit.costs,
        stages,
    )


def _is_doubtful(quality: Quality, state: TrackState) -> bool:
    """Whether the hand may well be elsewhere: worse than it was, or much is left unexplained."""
    return quality.score < state.score - SCORE_DROP or quality.explained < 1.0 - DOUBTFUL


def _running_score(state: TrackState, attempt: _Attempt | None, status: str) -> float:
    if attempt is None or status == "lost":
        return state.score
    if status == "recovered" or state.score == 0.0:
        return attempt.quality.score
    return SCORE_MEMORY * state.score + (1.0 - SCORE_MEMORY) * attempt.quality.score


def _follow(
    frame: Frame, camera: Camera, setup: TrackSetup, state: TrackState
) -> tuple[_Attempt | None, tuple[int, int, int], dict[str, float]]:
    """Fit from the predicted pose, and again after a search of fingers if that left something unexplained."""
    stages: dict[str, float] = {}
    rest = (max(0, state.rest[0] - 1), max(0, state.rest[1] - 1), state.rest[2])
    if state.is_lost:
        return None, rest, stages
    predicted = state.predict(setup.scene)
    started = perf_counter()
    seen = _look(frame, camera, setup, predicted)
    stages["observing"] = perf_counter() - started
    if seen is None:
        return None, rest, stages
    is_first = state.next_frame == setup.options.first_frame
    iterations = setup.options.first_iterations if is_first else setup.options.iterations
    options = FitOptions(iterations=iterations, stop_below=0.001 * setup.options.stop_below_mm)
    best = _attempt(setup, seen, predicted, state.pose, Objective(), options)
    stages |= best.fit.stages
    is_falling = best.quality.is_lost or best.quality.score < state.score - SCORE_DROP
    if is_falling or (best.quality.explained < 1.0 - UNEXPLAINED and rest[0] == 0):
        started = perf_counter()
        before = best.quality.score
        for start in (state.pose, best.pose) if is_falling else (best.pose,):
            other = _try_again(setup, seen, start, options)
            if other.quality.score > best.quality.score:
                best = other
        rest = (0 if best.quality.score > before + SCORE_GAIN else FINGER_REST, *rest[1:])
        stages["second try"] = perf_counter() - started
    return best, rest, stages


def _try_again(setup: TrackSetup, seen: Observation, start: Array, options: FitOptions) -> _Attempt:
    """A search of single fingers, a fit with longer reach, and the usual fit from there."""
    scene, pose = setup.scene, start
    thin = seen.thin(max(1, round((seen.hand_count / SCORED_PIXELS) ** 0.5)))
    for index, (model, where) in enumerate(zip(setup.models, scene.pose_slices, strict=True)):
        if model.hand:

            def score(trial: Array, index: int = index) -> float:
                return measure_quality(draw(scene.pose_at(trial), thin), thin, index).score

            pose = search_fingers(pose, where.start, model, score)
    wide = Objective(terms={**Objective().terms, **WIDE})
    far = FitOptions(iterations=options.iterations, damping=1e-2, max_turn=0.25, max_shift=0.02)
    pose = fit_frame(scene, seen, pose, pose, wide, far).pose
    return _attempt(setup, seen, pose, pose, Objective(), options)


def _attempt(
    setup: TrackSetup, seen: Observation, start: Array, previous: Array, objective: Objective, options: FitOptions
) -> _Attempt:
    fit = fit_frame(setup.scene, seen, start, previous, objective, options)
    view = draw(setup.scene.pose_at(fit.pose), seen)
    hands = [index for index, model in enumerate(setup.models) if model.hand]
    return _Attempt(fit.pose, {index: measure_quality(view, seen, index) for index in hands}, fit)


def _look(frame: Frame, camera: Camera, setup: TrackSetup, pose: Array) -> Observation | None:
    region = region_around(setup.scene.pose_at(pose).vertices, camera)
    if region is None:
        return None
    seen = observe(frame, camera, region, setup.preprocessing)
    return seen if seen.hand_count >= MIN_PIXELS else None


def _find_again(
    frame: Frame, camera: Camera, setup: TrackSetup, state: TrackState, attempt: _Attempt | None
) -> _Attempt | None:
    """Look for every hand that is lost, or failing that for the worst, in what the rest of the scene leaves over."""
    near, far = depth_range(frame)
    pose = (state.pose if attempt is None else attempt.pose).copy()
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
    seen = _look(frame, camera, setup, pose)
    if seen is None:
        return None
    again = _attempt(setup, seen, pose, pose, Objective(), FitOptions(iterations=setup.options.iterations))
    return None if again.quality.is_lost else again

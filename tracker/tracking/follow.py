"""Go from frame to frame: predict, fit, judge, and look for what was lost."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.sequence import Sequence
from tracker.tracking.attempt import Attempt, attempt_fit, find_again, look, try_again
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_fit import FitOptions
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.hold import hold_object
from tracker.tracking.quality import Quality
from tracker.tracking.setup import TrackSetup
from tracker.tracking.start_annotated import with_marks
from tracker.tracking.state import TrackState
from tracker.tracking.tools import Tools, make_tools
from tracker.tracking.watch_objects import stop_unseen, watch_objects

Array = npt.NDArray[np.float64]

SCORE_DROP = 0.10
"""A score this far below the running one calls for a second try."""

UNEXPLAINED = 0.15
"""So does this share of hand pixels that the model does not explain: a finger may be hidden in the palm."""

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
    with make_tools(setup, sequence.camera(setup.camera_id).T_world_camera) as tools:
        for index in frames:
            state, result = follow_frame(sequence, setup, tools, state, recover=setup.options.recover)
            results.append(result)
            if on_frame:
                on_frame(index, result)
    return state, TrackChunk.of(results)


def follow_frame(
    sequence: Sequence, setup: TrackSetup, tools: Tools, state: TrackState, recover: bool
) -> tuple[TrackState, FrameResult]:
    """Track the next frame."""
    read_at = perf_counter()
    frame, camera = setup.read(sequence, state.next_frame)
    started = perf_counter()
    attempt, rest, stages = _follow(frame, camera, setup, tools, state)
    status = "ok"
    if attempt is None or attempt.quality.is_lost:
        found = find_again(frame, camera, setup, tools, state.pose, attempt) if recover else None
        attempt, status = (found, "recovered") if found else (attempt, "lost")
    elif recover and rest[1] == 0 and _is_doubtful(attempt.quality, state):
        searched_at = perf_counter()
        found = find_again(frame, camera, setup, tools, state.pose, attempt)
        is_better = found is not None and found.quality.merit > attempt.quality.merit + SCORE_GAIN
        attempt, status = (found, "recovered") if found and is_better else (attempt, "ok")
        longer = 0 if is_better else min(max(FIRST_IMAGE_REST, 2 * rest[2]), LAST_IMAGE_REST)
        rest = (rest[0], longer, longer)
        stages["searching the image"] = perf_counter() - searched_at
    is_followed = status == "ok" and not state.is_lost
    is_lost = status == "lost" or attempt is None
    pose = state.pose if is_lost or attempt is None else attempt.pose
    known = None if is_lost or attempt is None else attempt.objects
    pose, objects = watch_objects(frame, camera, setup, pose, known, recover)
    seconds = perf_counter() - started
    stages["reading"] = started - read_at
    earlier = state.pose if is_followed else pose
    next_state = TrackState(
        state.next_frame + 1,
        pose,
        stop_unseen(setup, pose, earlier, objects),
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
        tuple(objects),
    )


def _is_doubtful(quality: Quality, state: TrackState) -> bool:
    """Whether the hand may well be elsewhere: worse than it was, or much is left unexplained."""
    return quality.score < state.score - SCORE_DROP or quality.explained < 1.0 - DOUBTFUL


def _running_score(state: TrackState, attempt: Attempt | None, status: str) -> float:
    if attempt is None or status == "lost":
        return state.score
    if status == "recovered" or state.score == 0.0:
        return attempt.quality.score
    return SCORE_MEMORY * state.score + (1.0 - SCORE_MEMORY) * attempt.quality.score


def _follow(
    frame: Frame, camera: Camera, setup: TrackSetup, tools: Tools, state: TrackState
) -> tuple[Attempt | None, tuple[int, int, int], dict[str, float]]:
    """Fit from the predicted pose, and again after a search of fingers if that left something unexplained."""
    stages: dict[str, float] = {}
    rest = (max(0, state.rest[0] - 1), max(0, state.rest[1] - 1), state.rest[2])
    if state.is_lost:
        return None, rest, stages
    predicted = state.predict(setup.scene)
    started = perf_counter()
    seen = look(frame, camera, setup, predicted)
    stages["observing"] = perf_counter() - started
    if seen is None:
        return None, rest, stages
    is_first = state.next_frame == setup.options.first_frame
    iterations = setup.options.first_iterations if is_first else setup.options.iterations
    options = FitOptions(iterations=iterations, stop_below=0.001 * setup.options.stop_below_mm)
    objective = tools.objective
    if is_first:
        objective = with_marks(objective, setup.scene, setup.names, setup.marks, camera)
    best = attempt_fit(setup, seen, predicted, state.pose, objective, options)
    stages |= best.fit.stages
    is_falling = best.quality.is_lost or best.quality.score < state.score - SCORE_DROP
    if is_falling or (best.quality.explained < 1.0 - UNEXPLAINED and rest[0] == 0):
        started = perf_counter()
        before = best.quality.score
        guided = tools.with_fingertips(seen)
        for start in (state.pose, best.pose) if is_falling else (best.pose,):
            other = try_again(setup, seen, start, objective, guided, options)
            if other.quality.score > best.quality.score:
                best = other
        rest = (0 if best.quality.score > before + SCORE_GAIN else FINGER_REST, *rest[1:])
        stages["second try"] = perf_counter() - started
    if tools.world is not None:
        started = perf_counter()
        best = hold_object(setup, tools, seen, objective, state, best, options)
        stages["physics"] = perf_counter() - started
    return best, rest, stages

"""Go from frame to frame: predict, fit, judge, and look for what was lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.sequence import Sequence
from tracker.observation import Observation
from tracker.tracking.attempt import MIN_PIXELS, UNSETTLED, Attempt, attempt_fit, look, try_again
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.find_again import find_again, find_seen
from tracker.tracking.frame_fit import FitOptions
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.hold import hold_object
from tracker.tracking.object_quality import ObjectQuality
from tracker.tracking.objective import Objective
from tracker.tracking.part import Part
from tracker.tracking.quality import Quality
from tracker.tracking.region import is_outgrown, region_around
from tracker.tracking.seen_hands import try_where_seen
from tracker.tracking.setup import TrackSetup
from tracker.tracking.sighting import Sightings, find_sightings
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

FIRST_FINGER_REST, LAST_FINGER_REST = 4, 64
FIRST_IMAGE_REST, LAST_IMAGE_REST = 15, 120
"""Frames to wait after a search in vain, of fingers or of the image: the first time, and at most; the wait doubles each
time."""

SCORE_MEMORY = 0.9
"""Share of the running score kept from frame to frame."""

Rest = tuple[int, int, int, int]


SEEN_ITERATIONS = 1.5
"""Fits from the detector's joints take so many times the iterations of others: they start farther off."""

WIDER = 3
"""So often at most the region follows a fit that went beyond it."""


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
    lost = _lost_before(setup, state)
    sightings = find_sightings(setup.hand_detector, frame, camera, setup.hand_names, state.detected)
    frame, detected_at = sightings.frame, perf_counter()
    attempt, rest, stages = _follow(sightings, camera, Part.without(setup, lost), tools, state)
    stages["detecting hands"] = detected_at - started
    falling = _fallen(setup, attempt, lost)
    status = "ok"
    if falling or attempt is None:
        searched_at = perf_counter()
        is_detecting = _is_detecting(setup, sightings)
        may_search = not is_detecting or (rest[1] == 0 and rest[2] > 0)
        attempt, status, falling = _catch(sightings, camera, setup, tools, state, attempt, falling, recover, may_search)
        if is_detecting and rest[1] == 0:  # the detector may see the hand again soon: wait, search, wait longer
            longer = 0 if status == "recovered" else min(max(FIRST_IMAGE_REST, 2 * rest[2]), LAST_IMAGE_REST)
            rest = (rest[0], longer, longer, rest[3])
        stages["searching the image"] = perf_counter() - searched_at
    elif recover and not _is_detecting(setup, sightings) and rest[1] == 0 and _is_doubtful(attempt.quality, state):
        searched_at = perf_counter()
        found = find_again(sightings, camera, setup, tools, attempt.pose, (attempt.worst,))
        is_better = found is not None and not found[1] and found[0].worth > attempt.worth + SCORE_GAIN
        attempt, status = (found[0], "recovered") if found and is_better else (attempt, "ok")
        longer = 0 if is_better else min(max(FIRST_IMAGE_REST, 2 * rest[2]), LAST_IMAGE_REST)
        rest = (rest[0], longer, longer, rest[3])
        stages["searching the image"] = perf_counter() - searched_at
    if attempt is not None and not falling and attempt.lost:
        status = "lost"  # in its place, some finger elsewhere: followed on, not to be believed
    pose = state.pose if attempt is None else attempt.pose
    # Before a hand that is lost nobody can tell a hidden object from a lost one: it is followed on, not looked for.
    look_for_objects = recover and not falling
    pose, objects = watch_objects(frame, camera, setup, pose, _known_objects(attempt, falling), look_for_objects)
    seconds = perf_counter() - started
    stages["reading"] = started - read_at
    next_state = TrackState(
        state.next_frame + 1,
        pose,
        stop_unseen(setup, pose, _earlier(setup, state, pose, status, (*lost, *falling)), objects),
        _running_score(state, attempt, status),
        bool(falling),
        rest,
        falling,
        {name: sighting.hand for name, sighting in sightings.hands.items()},
    )
    return next_state, FrameResult(
        state.next_frame,
        pose,
        status,
        seconds,
        attempt.quality if attempt is not None and attempt.qualities else None,
        () if attempt is None else attempt.fit.costs,
        stages,
        tuple(objects),
    )


def _is_detecting(setup: TrackSetup, sightings: Sightings) -> bool:
    """Whether the hand detector can see the frame; then the depth image is searched seldom: it takes seconds."""
    return setup.hand_detector is not None and sightings.frame.color is not None


def _hands(setup: TrackSetup) -> tuple[int, ...]:
    return tuple(index for index, model in enumerate(setup.models) if model.hand is not None)


def _lost_before(setup: TrackSetup, state: TrackState) -> tuple[int, ...]:
    """Hands that were lost in the last frame."""
    return (state.lost_hands or _hands(setup)) if state.is_lost else ()


def _fallen(setup: TrackSetup, attempt: Attempt | None, lost: tuple[int, ...]) -> tuple[int, ...]:
    """Hands that are gone now: those that were, and those that are not in their place."""
    return _hands(setup) if attempt is None else tuple(sorted({*lost, *attempt.gone}))


def _catch(
    sightings: Sightings,
    camera: Camera,
    setup: TrackSetup,
    tools: Tools,
    state: TrackState,
    attempt: Attempt | None,
    falling: tuple[int, ...],
    recover: bool,
    may_search: bool,
) -> tuple[Attempt | None, str, tuple[int, ...]]:
    """Follow the rest of the scene without hands that are lost, and look for them: attempt, status, still lost.

    The whole depth image is searched for what the detector does not see, if that may take its seconds.
    """
    if attempt is not None and attempt.gone:  # a hand that is not there has pulled at the others
        attempt = _follow(sightings, camera, Part.without(setup, falling), tools, state)[0]
        falling = _fallen(setup, attempt, falling)
    if recover:
        pose = state.pose if attempt is None else attempt.pose
        found = find_seen(sightings, camera, setup, tools, pose, falling)
        if found is None and may_search:
            found = find_again(sightings, camera, setup, tools, pose, falling)
        if found is not None:
            return found[0], "lost" if found[1] else "recovered", found[1]
    return attempt, "lost", falling


def _known_objects(attempt: Attempt | None, lost: tuple[int, ...]) -> dict[int, ObjectQuality] | None:
    """Quality of each object, where no lost hand stands before it."""
    return None if attempt is None or lost else attempt.objects


def _earlier(setup: TrackSetup, state: TrackState, pose: Array, status: str, lost: tuple[int, ...]) -> Array:
    """The pose (D,) before, to predict from; what was not followed from there is at rest."""
    earlier = pose if status == "recovered" else state.pose
    earlier = earlier.copy()
    for index in lost:
        earlier[setup.scene.pose_slices[index]] = pose[setup.scene.pose_slices[index]]
    return earlier


def _is_doubtful(quality: Quality, state: TrackState) -> bool:
    """Whether the hand may well be elsewhere: worse than it was, or much is left unexplained."""
    return quality.is_lost or quality.score < state.score - SCORE_DROP or quality.explained < 1.0 - DOUBTFUL


def _running_score(state: TrackState, attempt: Attempt | None, status: str) -> float:
    if attempt is None or status == "lost":
        return state.score
    if status == "recovered" or state.score == 0.0:
        return attempt.quality.score
    return SCORE_MEMORY * state.score + (1.0 - SCORE_MEMORY) * attempt.quality.score


def _follow(
    sightings: Sightings, camera: Camera, part: Part, tools: Tools, state: TrackState
) -> tuple[Attempt | None, Rest, dict[str, float]]:
    """Fit a part of the scene from the predicted pose, and try again if that left something unexplained."""
    stages: dict[str, float] = {}
    rest = (max(0, state.rest[0] - 1), max(0, state.rest[1] - 1), *state.rest[2:])
    if not part.kept:
        return None, rest, stages
    setup, previous = part.setup, part.take(state.pose)
    predicted = replace(state, pose=previous, earlier_pose=part.take(state.earlier_pose)).predict(setup.scene)
    started = perf_counter()
    frame = sightings.frame
    seen = look(frame, camera, setup, predicted, MIN_PIXELS if part.has_hand else 0)
    stages["observing"] = perf_counter() - started
    if seen is None:
        return None, rest, stages
    is_first = state.next_frame == setup.options.first_frame
    iterations = setup.options.first_iterations if is_first else setup.options.iterations
    options = FitOptions(
        iterations=iterations, stop_below=0.001 * setup.options.stop_below_mm, threads=min(setup.options.threads, 2)
    )
    objective = tools.objective
    if sightings.is_covered and not setup.object_names:
        objective = sightings.add_to(objective, setup.scene, setup.names, camera)
    if is_first:
        objective = with_marks(objective, setup.scene, setup.names, setup.marks, camera)
    best = attempt_fit(setup, seen, predicted, previous, objective, options)
    stages |= best.fit.stages
    seen, best = _look_wider(frame, camera, setup, seen, best, previous, objective, options)
    is_whole = setup is part.whole  # otherwise what nobody explains may be of a hand that is left out
    if best.qualities and sightings.hands:
        started = perf_counter()
        again = replace(options, iterations=round(SEEN_ITERATIONS * setup.options.iterations))
        best = try_where_seen(setup, camera, sightings, best, objective, again)
        stages["second try"] = perf_counter() - started
    if best.qualities:
        is_falling = bool(best.lost if is_whole else best.gone) or best.quality.score < state.score - SCORE_DROP
        is_unsettled = is_whole and (best.quality.explained < 1.0 - UNEXPLAINED or best.misfit > UNSETTLED)
        may_search = rest[0] == 0
        if _is_detecting(setup, sightings):
            is_unsettled |= is_falling
            is_falling = False
            may_search &= not all(setup.names[hand] in sightings.hands for hand in best.qualities)
        if is_falling or (is_unsettled and may_search):
            started = perf_counter()
            first = best
            guided, again = tools.with_fingertips(seen), replace(options, iterations=setup.options.iterations)
            for start in (previous, best.pose) if is_falling else (best.pose,):
                other = try_again(setup, seen, start, objective, guided, again)
                best = other if other.worth > best.worth else best
                if best.misfit < UNSETTLED:
                    break
            is_better = best.misfit < UNSETTLED or best.worth > first.worth + SCORE_GAIN
            longer = 0 if is_better else min(max(FIRST_FINGER_REST, 2 * rest[3]), LAST_FINGER_REST)
            rest = (longer, *rest[1:3], longer)
            seen, best = _look_wider(frame, camera, setup, seen, best, previous, objective, again)
            stages["second try"] = perf_counter() - started
        if tools.world is not None and is_whole:
            started = perf_counter()
            best = hold_object(setup, tools, seen, objective, state, best, options)
            stages["physics"] = perf_counter() - started
    return part.widen(best, state.pose), rest, stages


def _look_wider(
    frame: Frame,
    camera: Camera,
    setup: TrackSetup,
    seen: Observation,
    best: Attempt,
    previous: Array,
    objective: Objective,
    options: FitOptions,
) -> tuple[Observation, Attempt]:
    """What is seen around the pose that was found, and a fit to that, if it went so far that part of it was cut off."""
    for _ in range(WIDER):
        needed = region_around(setup.scene.pose_at(best.pose).vertices, camera)
        if needed is None or not is_outgrown(seen.region, needed, camera):
            break
        wider = look(frame, camera, setup, best.pose)
        if wider is None:
            break
        seen, best = wider, attempt_fit(setup, wider, best.pose, previous, objective, options)
    return seen, best

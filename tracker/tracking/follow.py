"""Go from frame to frame: predict, fit, judge, and look for what was lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings, find_sightings
from tracker.search.part import Part
from tracker.search.tools import Tools, make_tools
from tracker.tracking.ahead import FrameRead, FramesAhead, Glance, ViewsAhead, read_ahead
from tracker.tracking.as_written import follow_as_written
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.follow_part import follow_part
from tracker.tracking.follow_views import follow_views
from tracker.tracking.frame_result import FrameResult, tell_statuses
from tracker.tracking.recovery import Recovery, recover_hands
from tracker.tracking.state import TrackState
from tracker.tracking.watch_objects import stop_unseen, watch_objects

Array = npt.NDArray[np.float64]


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
    results = []
    with (
        make_tools(setup, sequence.camera(setup.camera_id).T_world_camera) as tools,
        read_ahead(sequence, setup, frames.stop) as ahead,
    ):
        cv2.setNumThreads(1 if ahead else setup.options.threads)
        for index in frames:
            state, result = follow_frame(sequence, setup, tools, state, setup.options.recover, ahead)
            results.append(result)
            if on_frame:
                on_frame(index, result)
    return state, TrackChunk.of(results)


def follow_frame(
    sequence: Sequence,
    setup: TrackSetup,
    tools: Tools,
    state: TrackState,
    recover: bool,
    ahead: FramesAhead | ViewsAhead | None = None,
) -> tuple[TrackState, FrameResult]:
    """Track the next frame.

    Args:
        sequence: The recording.
        setup: Models and options.
        tools: Of the run.
        state: After the frame before.
        recover: Whether to look for what is lost.
        ahead: Prepares the frame after this one meanwhile. The seconds of a frame are then those of the clock from one
            frame's pose to the next one's, with what it had to wait for.
    """
    if setup.options.is_as_written:
        return follow_as_written(sequence, setup, tools, state)
    if setup.view_ids:
        assert not isinstance(ahead, FramesAhead)
        return follow_views(sequence, setup, tools, state, ahead)[:2]
    assert not isinstance(ahead, ViewsAhead)
    started = perf_counter()
    glance = _glance(setup, state)
    read = ahead.take(glance) if ahead else FrameRead.of(sequence, setup, state.next_frame)
    if not ahead:
        started = perf_counter()
    sightings = _sight(read, glance, setup, state)
    detected = sightings.followed
    if ahead:
        ahead.begin(_glance(setup, replace(state, next_frame=state.next_frame + 1, detected=detected)))
    detected_at = perf_counter()
    followed = follow_part(sightings, Part.without(setup, state.gone_hands(setup)), tools, state)
    searched_at = perf_counter()
    recovery = recover_hands(sightings, setup, tools, state, followed.attempt, recover)
    stages = {**followed.stages, "reading": read.seconds, "detecting hands": detected_at - started}
    stages["searching the image"] = perf_counter() - searched_at
    attempt, gone = recovery.attempt, recovery.gone
    hand_status = _judge(setup, recovery)
    pose = state.pose if attempt is None else attempt.pose
    # Before a hand that is lost nobody can tell a hidden object from a lost one: it is followed on, not looked for.
    known = None if attempt is None or gone else attempt.objects
    pose, objects = watch_objects(sightings.frame, read.camera, setup, pose, known, recover and not gone)
    next_state = TrackState(
        next_frame=state.next_frame + 1,
        pose=pose,
        earlier_pose=stop_unseen(setup, pose, _earlier(setup, state, pose, recovery), objects),
        is_lost=bool(gone),
        second_try=followed.second_try,
        tips=followed.tips,
        lost_hands=gone,
        detected=detected,
    )
    seconds = perf_counter() - started
    return next_state, FrameResult.of(state.next_frame, pose, hand_status, seconds, attempt, stages, objects)


def _glance(setup: TrackSetup, state: TrackState) -> Glance:
    """How the detector looks at the next frame: once something is followed, at two turns of the image."""
    is_followed = state.next_frame > setup.options.first_frame and len(state.gone_hands(setup)) < len(setup.hands)
    turns = (0, 1 + state.next_frame % 3) if is_followed else (0, 1, 2, 3)
    return Glance(state.next_frame, state.detected, turns)


def _sight(read: FrameRead, glance: Glance, setup: TrackSetup, state: TrackState) -> Sightings:
    """What the detector sees of the hands, with what is expected of those that are followed.

    A detector that overlooks a hand for some frames leaves its pixels to be told by where they should be now: from the
    second frame on.
    """
    gone = {setup.names[hand] for hand in state.gone_hands(setup)}
    is_first = state.next_frame == setup.options.first_frame
    projected = {} if is_first else setup.project_hands(state.predict(setup.scene), read.camera)
    expected = {name: joints for name, joints in projected.items() if name not in gone}
    if read.sightings is not None:
        return read.sightings.with_tips(expected)
    names, detector = setup.hand_names, setup.hand_detector
    return find_sightings(detector, read.frame, read.camera, names, glance.before, expected, glance.turns)


def _judge(setup: TrackSetup, recovery: Recovery) -> tuple[str, ...]:
    """Status of each hand; one that is in its place with some finger elsewhere is followed on, not to be believed."""
    lost = set(recovery.gone) | set(() if recovery.attempt is None else recovery.attempt.lost)
    return tell_statuses(setup.hands, lost, recovery.found)


def _earlier(setup: TrackSetup, state: TrackState, pose: Array, recovery: Recovery) -> Array:
    """The pose (D,) before, to predict from; what was not followed from there is at rest."""
    earlier = (pose if recovery.found and not recovery.gone else state.pose).copy()
    for index in {*state.gone_hands(setup), *recovery.gone}:
        earlier[setup.scene.pose_slices[index]] = pose[setup.scene.pose_slices[index]]
    return earlier

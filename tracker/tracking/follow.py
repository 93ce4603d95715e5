"""Go from frame to frame: predict, fit, judge, and look for what was lost."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.sequence import Sequence
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import find_sightings
from tracker.search.part import Part
from tracker.search.tools import Tools, make_tools
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
    if setup.options.is_as_written:
        return follow_as_written(sequence, setup, tools, state)
    if setup.view_ids:
        return follow_views(sequence, setup, tools, state)[:2]
    read_at = perf_counter()
    frame, camera = setup.read(sequence, state.next_frame)
    started = perf_counter()
    expected = _expect(setup, state, camera)
    turns = (0, 1 + frame.index % 3) if expected else (0, 1, 2, 3)
    sightings = find_sightings(setup.hand_detector, frame, camera, setup.hand_names, state.detected, expected, turns)
    detected_at = perf_counter()
    followed = follow_part(sightings, Part.without(setup, state.gone_hands(setup)), tools, state)
    searched_at = perf_counter()
    recovery = recover_hands(sightings, setup, tools, state, followed.attempt, recover)
    stages = {**followed.stages, "reading": started - read_at, "detecting hands": detected_at - started}
    stages["searching the image"] = perf_counter() - searched_at
    attempt, gone = recovery.attempt, recovery.gone
    hand_status = _judge(setup, recovery)
    pose = state.pose if attempt is None else attempt.pose
    # Before a hand that is lost nobody can tell a hidden object from a lost one: it is followed on, not looked for.
    known = None if attempt is None or gone else attempt.objects
    pose, objects = watch_objects(sightings.frame, camera, setup, pose, known, recover and not gone)
    next_state = TrackState(
        next_frame=state.next_frame + 1,
        pose=pose,
        earlier_pose=stop_unseen(setup, pose, _earlier(setup, state, pose, recovery), objects),
        is_lost=bool(gone),
        second_try=followed.second_try,
        tips=followed.tips,
        lost_hands=gone,
        detected=sightings.followed,
    )
    seconds = perf_counter() - started
    return next_state, FrameResult.of(state.next_frame, pose, hand_status, seconds, attempt, stages, objects)


def _expect(setup: TrackSetup, state: TrackState, camera: Camera) -> dict[str, Array]:
    """Joints (21, 2) px of the hands that are followed, where they should be in the next frame; none before the first.

    A detector that overlooks a hand for some frames leaves its pixels to be told by these.
    """
    if state.next_frame == setup.options.first_frame:
        return {}
    gone = {setup.names[hand] for hand in state.gone_hands(setup)}
    expected = setup.project_hands(state.predict(setup.scene), camera)
    return {name: joints for name, joints in expected.items() if name not in gone}


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

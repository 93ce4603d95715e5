"""Calibrate the hands of a run: follow the scene for 60 frames, fit the shapes to good ones that differ, and again."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.fitting.calibration import CalibrationFrame, CalibrationOptions, calibrate_shapes
from tracker.fitting.objective import Objective
from tracker.fitting.region import region_around
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import find_sightings
from tracker.observation import observe
from tracker.search.seen_hands import FINGER_AGREES
from tracker.search.tools import Tools
from tracker.terms.marked_joints import mark_joints
from tracker.tracking.follow import follow_frame
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.state import TrackState

log = logging.getLogger(__name__)

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

WELL_EXPLAINED = 0.8
"""A frame says something about a hand's shape when this share of the hand's pixels is explained."""

WHOLE = 0.9
"""Share of a hand's own movement that is left out when poses are compared; what remains tells views apart."""


FEWEST_PIXELS = 200
"""A frame with fewer hand pixels says nothing of a hand's shape."""


@dataclass(frozen=True)
class Pass:
    """One time through the beginning of the recording.

    Attributes:
        followed: So many frames at most.
        fitted: So many of these at most.
        options: How.
    """

    followed: int
    fitted: int
    options: CalibrationOptions


PASSES = (
    Pass(30, 8, CalibrationOptions(rounds=4, coarse_rounds=4)),
    Pass(60, 16, CalibrationOptions()),
)
"""The first makes the second follow better."""


def name_pass(what: str, number: int) -> str:
    """Name of a stage of a pass, counted from 1, for people."""
    return f"{what} ({number} of {len(PASSES)})"


def calibrate_hands(
    sequence: Sequence,
    setup: TrackSetup,
    frames: range,
    pose: Array,
    tell: Progress,
) -> tuple[TrackSetup, Array]:
    """The setup with the hands that have a shape basis fitted, and the pose (D,) in the first frame.

    Args:
        sequence: The recording.
        setup: Hands and objects as they were placed.
        frames: Of the run.
        pose: (D,) in the first of them.
        tell: Told the stage and its share done.
    """
    for number, each in enumerate(PASSES, 1):
        following, fitting = name_pass("following", number), name_pass("fitting the shape", number)
        first, poses = _follow(
            sequence, setup, frames[: each.followed], pose, lambda share, stage=following: tell(stage, share)
        )
        chosen = _choose(setup, poses, each.fitted)
        seen = [_look(sequence, setup, frames[place], poses[place], place == 0) for place in chosen]
        known = [frame for frame in seen if frame is not None]
        if not known:
            break
        found = calibrate_shapes(setup.scene, known, each.options, lambda share, stage=fitting: tell(stage, share))
        setup = replace(setup, models=found.models)
        pose = found.poses[0] if chosen[0] == 0 and seen[0] is not None else first
        for name, values in zip(setup.names, found.values, strict=True):
            largest = sorted(values.items(), key=lambda item: -abs(item[1]))[:12]
            if values:
                log.info("%s shape: %s", name, ", ".join(f"{key} {value:+.2f}" for key, value in largest))
    return setup, pose


def _follow(
    sequence: Sequence, setup: TrackSetup, frames: range, pose: Array, tell: Callable[[float], None]
) -> tuple[Array, dict[int, Array]]:
    """The pose (D,) in the first frame, and place in `frames` to the pose of each that tells what shape a hand has."""
    state = TrackState(frames[0], pose, pose)
    tools = Tools(Objective(), None, None)
    first, poses = pose, {}
    for place in range(len(frames)):
        state, result = follow_frame(sequence, setup, tools, state, recover=setup.hand_detector is not None)
        first = state.pose if place == 0 else first
        if _tells_shape(result) or (place == 0 and setup.marks):
            poses[place] = state.pose
        tell((place + 1) / len(frames))
    return first, poses


def _tells_shape(result: FrameResult) -> bool:
    """Whether every hand is in its place and explained; a finger that is elsewhere would bend the shape."""
    quality = result.quality
    if result.status == "lost" or quality is None or quality.explained < WELL_EXPLAINED:
        return False
    return quality.worst_finger is None or quality.worst_finger <= FINGER_AGREES


def _choose(setup: TrackSetup, poses: dict[int, Array], count: int) -> list[int]:
    """At most this many places, in order: the earliest, and always the one that is least like those already chosen."""
    places = sorted(poses)
    if not places:
        return []
    looks = []
    for place in places:
        posed = setup.scene.pose_at(poses[place])
        hands = [posed.landmarks(index) for index, model in enumerate(setup.models) if model.hand]
        looks.append(np.concatenate([joints - WHOLE * joints.mean(axis=0) for joints in hands]).ravel())
    chosen = [0]
    while len(chosen) < min(count, len(places)):
        away = np.min([np.linalg.norm(np.array(looks) - looks[other], axis=1) for other in chosen], axis=0)
        chosen.append(int(np.argmax(away)))
    return sorted(places[index] for index in chosen)


def _look(sequence: Sequence, setup: TrackSetup, index: int, pose: Array, is_first: bool) -> CalibrationFrame | None:
    """What is seen and marked in a frame; None where too little of a hand shows."""
    frame, camera = setup.read(sequence, index)
    expected = setup.project_hands(pose, camera)
    frame = find_sightings(setup.hand_detector, frame, camera, setup.hand_names, {}, expected).frame
    region = region_around(setup.scene.pose_at(pose).vertices, camera)
    if region is None:
        return None
    seen = observe(frame, camera, region, setup.preprocessing)
    if seen.hand_count < FEWEST_PIXELS:
        return None
    marks = setup.marks if is_first else {}
    joints = {
        model: mark_joints(setup.scene, model, marks[name], camera)
        for model, name in enumerate(setup.names)
        if name in marks
    }
    return CalibrationFrame(seen, pose, joints)

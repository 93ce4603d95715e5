"""Calibrate the hands of a run: follow the scene for two seconds, fit the shapes to frames that differ, and again."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.observation import observe
from tracker.terms.marked_joints import mark_joints
from tracker.tracking.calibration import CalibrationFrame, CalibrationOptions, calibrate_shapes
from tracker.tracking.follow import follow_frame
from tracker.tracking.objective import Objective
from tracker.tracking.region import region_around
from tracker.tracking.setup import TrackSetup
from tracker.tracking.sighting import find_sightings
from tracker.tracking.state import TrackState
from tracker.tracking.tools import Tools

log = logging.getLogger(__name__)

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

WELL_EXPLAINED = 0.8
"""A frame says something about a hand's shape when this share of the hand's pixels is explained."""

FALLEN = 0.9
"""Following ends where the merit falls below this share of the first frame's."""

WHOLE = 0.9
"""Share of a hand's own movement that is left out when poses are compared; what remains tells views apart."""


FEWEST_PIXELS = 200
"""A frame with fewer hand pixels says nothing of a hand's shape."""


@dataclass(frozen=True)
class Pass:
    """One time through the beginning of the recording.

    Attributes:
        seconds: So much of it is followed.
        frames: So many are fitted to.
        options: How.
    """

    seconds: float
    frames: int
    options: CalibrationOptions

    def count_frames(self, there: int, fps: float) -> int:
        """Of `there` frames, so many are followed."""
        return max(1, min(there, round(self.seconds * fps)))


PASSES = (
    Pass(1.0, 8, CalibrationOptions(rounds=4, coarse_rounds=4)),
    Pass(2.0, 16, CalibrationOptions()),
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
        last = each.count_frames(len(frames), sequence.fps)
        following, fitting = name_pass("following", number), name_pass("fitting the shape", number)
        poses = _follow(sequence, setup, frames[:last], pose, lambda share, stage=following: tell(stage, share))
        chosen = _choose(setup, poses, each.frames)
        seen = [_look(sequence, setup, frames, place, poses[place]) for place in chosen]
        known = [frame for frame in seen if frame is not None]
        if not known or seen[0] is None:
            break
        found = calibrate_shapes(setup.scene, known, each.options, lambda share, stage=fitting: tell(stage, share))
        setup = replace(setup, models=found.models)
        pose = found.poses[0]
        for name, values in zip(setup.names, found.values, strict=True):
            largest = sorted(values.items(), key=lambda item: -abs(item[1]))[:12]
            if values:
                log.info("%s shape: %s", name, ", ".join(f"{key} {value:+.2f}" for key, value in largest))
    return setup, pose


def _follow(
    sequence: Sequence, setup: TrackSetup, frames: range, pose: Array, tell: Callable[[float], None]
) -> dict[int, Array]:
    """Place in `frames` to the pose (D,) of those that went well, while it goes well; the first is always there."""
    state = TrackState(frames[0], pose, pose)
    tools = Tools(Objective(), None, None)
    poses: dict[int, Array] = {}
    first_merit = 0.0
    for place in range(len(frames)):
        state, result = follow_frame(sequence, setup, tools, state, recover=False)
        quality = result.quality
        if place == 0:
            first_merit = 0.0 if quality is None else quality.merit
        elif result.status != "ok" or quality is None or quality.merit < FALLEN * first_merit:
            break
        if place == 0 or (quality is not None and quality.explained >= WELL_EXPLAINED):
            poses[place] = state.pose
        tell((place + 1) / len(frames))
    return poses


def _choose(setup: TrackSetup, poses: dict[int, Array], count: int) -> list[int]:
    """At most so many places, in order: the first, and always the one that is least like those already chosen."""
    places = sorted(poses)
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


def _look(sequence: Sequence, setup: TrackSetup, frames: range, place: int, pose: Array) -> CalibrationFrame | None:
    frame, camera = setup.read(sequence, frames[place])
    frame = find_sightings(setup.hand_detector, frame, camera, setup.hand_names, {}).frame
    region = region_around(setup.scene.pose_at(pose).vertices, camera)
    if region is None:
        return None
    seen = observe(frame, camera, region, setup.preprocessing)
    if seen.hand_count < FEWEST_PIXELS:
        return None
    marks = {} if place > 0 else setup.marks
    joints = {
        model: mark_joints(setup.scene, model, marks[name], camera)
        for model, name in enumerate(setup.names)
        if name in marks
    }
    return CalibrationFrame(seen, pose, joints)

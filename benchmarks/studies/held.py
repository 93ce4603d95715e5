"""Displacement after simulation on a twin, [T16] §4.2.1: does what the hand holds stay where it is?"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from benchmarks.studies.twin_runs import Twin, measure, render_twin, run_twin, start_twin
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.model.scene import PosedScene
from tracker.physics import SD_OBMAN, SEARCH, find_settled_displacement, simulate
from tracker.synthesis.actor import Actor

STABLE = 0.003
"""An object that moves less stays, m (§3.2.6)."""

CARRIED = 0.005
"""Where the object is farther than this from its first and from its last place, m, nothing but the hand carries it."""

ENDS = 10
"""Frames at the beginning and at the end in which it rests."""

SIDE = 0.1
"""A side of an object is flat enough to lie on if it is so much of its surface."""

SAME_SIDE = 0.97
"""Cosine between the normals of faces of one side."""


@dataclass(frozen=True)
class Held:
    """The object's displacement in the frames in which the motion says that it is held, with a set of terms.

    No table is rendered, so frames in which the object rests on one do not count. Gravity is that of the table: along
    the normal of the side that the object lies on at first, if it has sides, else along the camera's +y.
    """

    sequence: str
    terms: str
    frames: int | None = None
    own_hand: bool = False

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Track and let go."""
        twin = render_twin(data, twins, self.sequence, self.frames, 1, 0)
        down = find_lying_side(twin.performance.objects[0])
        twin = replace(twin, sequence=replace(twin.sequence, gravity=down))
        true_setup, _ = start_twin(twin, TrackOptions(calibrate=False, use_detector=False))
        options = TrackOptions(terms=self.terms, calibrate=self.own_hand, use_detector=False)
        setup, state = start_twin(twin, options, self.own_hand)
        track = run_twin(twin, setup, state)
        held = find_carried_frames(twin)
        poses = [setup.scene.pose_at(track.pose[np.searchsorted(track.frame, frame)]) for frame in held]
        true_poses = [pose_truth(twin, true_setup, frame) for frame in held]
        error = measure(twin, track)
        return {
            "frames": len(track.frame),
            "held": len(held),
            "down": down,
            "px": error["px"],
            "lost": error["lost"],
            "median_ms": error["median_ms"],
            "ours": _let_go(setup, poses),
            "truth": _let_go(true_setup, true_poses),
        }


def _let_go(setup: TrackSetup, poses: list[PosedScene]) -> dict[str, Any]:
    """Means and medians, mm, and how many stay: as the tracker judges it, and from the poses exactly as they are."""
    with setup.make_world(np.eye(4)) as world:
        settled = 1e3 * np.array([find_settled_displacement(world, posed) for posed in poses])
        moved = 1e3 * np.array([simulate(world, posed, SEARCH) for posed in poses])
        points = 1e3 * np.array([simulate(world, posed, SD_OBMAN) for posed in poses])
    if not len(poses):
        return {"stable": 0}
    return {
        "stable": int(np.count_nonzero(settled < 1e3 * STABLE)),
        "mean_mm": float(moved.mean()),
        "median_mm": float(np.median(moved)),
        "points_stable": int(np.count_nonzero(points < 1e3 * STABLE)),
        "points_mean_mm": float(points.mean()),
    }


def find_carried_frames(twin: Twin) -> list[int]:
    """Frames in which the object is neither where it was at first nor where it is at last."""
    actor = twin.performance.objects[0]
    middles = np.array([actor.vertices(int(moment)).mean(axis=0) for moment in twin.truth.source_frame])
    ends = (np.median(part, axis=0) for part in (middles[:ENDS], middles[-ENDS:]))
    is_away = np.all([np.linalg.norm(middles - end, axis=1) > CARRIED for end in ends], axis=0)
    return [int(frame) for frame in twin.truth.frame[is_away]]


def find_lying_side(actor: Actor) -> tuple[float, float, float] | None:
    """(3,) unit, world: the outward normal of the side that an object lies on at first; None where it has no sides."""
    corners = actor.vertices(0)[actor.model.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    normals = normals / np.maximum(areas, 1e-12)[:, None]
    sides: list[npt.NDArray[np.float64]] = []
    left = np.ones(len(areas), dtype=bool)
    while left.any():
        largest = normals[np.argmax(np.where(left, areas, -1.0))]
        is_side = left & (normals @ largest > SAME_SIDE)
        if not is_side.any():
            break
        left &= ~is_side
        if areas[is_side].sum() > SIDE * areas.sum():
            mean = areas[is_side] @ normals[is_side]
            sides.append(mean / np.linalg.norm(mean))
    if not sides:
        return None
    x, y, z = max(sides, key=lambda side: float(side[1])).tolist()
    return x, y, z


def pose_truth(twin: Twin, setup: TrackSetup, frame: int) -> PosedScene:
    """The scene with every bone where it truly was; only the bones, which is all that hulls follow."""
    actors = {actor.name: actor for actor in twin.performance.actors}
    moment = int(twin.truth.source_frame[np.searchsorted(twin.truth.frame, frame)])
    rest = setup.scene.pose_at(setup.scene.rest_pose())
    return replace(rest, Ms=np.concatenate([actors[name].Ms[moment] for name in setup.names]))

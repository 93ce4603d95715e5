"""Displacement after simulation on a twin, [T16] §4.2.1: does what the hand holds stay where it is?"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.studies.twin_runs import Twin, render_twin, run_twin, start_twin
from tracker.model.scene import PosedScene
from tracker.physics import SD_OBMAN, PhysicsWorld, find_down, measure_displacement, simulate
from tracker.tracking.options import TrackOptions
from tracker.tracking.setup import TrackSetup

HELD = 0.003
"""A frame counts where the truth's own displacement is at most this under SD-obman, m."""


@dataclass(frozen=True)
class Held:
    """The object's displacement in the frames where the truth holds it, with a set of terms.

    Under SD-obman (docs/physics.md), where the true poses hold; the mean under T16's own time-step stands beside it,
    though nearly everything falls there, the truth included.
    """

    sequence: str
    terms: str
    frames: int | None = None
    own_hand: bool = False

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Track and let go."""
        twin = render_twin(data, twins, self.sequence, self.frames, 1, 0)
        true_setup, _ = start_twin(twin, TrackOptions(calibrate=False))
        setup, state = start_twin(twin, TrackOptions(terms=self.terms, calibrate=self.own_hand), self.own_hand)
        track = run_twin(twin, setup, state)
        down = find_down(twin.sequence.camera(setup.camera_id).T_world_camera)
        own, own_seed, true = [], [], []
        with (
            PhysicsWorld(setup.scene, down=down) as world,
            PhysicsWorld(true_setup.scene, down=down) as true_world,  # truth has the hand that was rendered
        ):
            for frame, pose in zip(track.frame, track.pose, strict=True):
                truth = simulate(true_world, pose_truth(twin, true_setup, int(frame)), SD_OBMAN)
                if truth <= HELD:
                    moved = measure_displacement(world, setup.scene.pose_at(pose))
                    own.append(1e3 * moved.obman)
                    own_seed.append(1e3 * moved.seed)
                    true.append(1e3 * truth)
        count = len(own)
        return {
            "frames": len(track.frame),
            "held": count,
            "mean_mm": float(np.mean(own)) if count else None,
            "median_mm": float(np.median(own)) if count else None,
            "seed_mean_mm": float(np.mean(own_seed)) if count else None,
            "true_mean_mm": float(np.mean(true)) if count else None,
        }


def pose_truth(twin: Twin, setup: TrackSetup, frame: int) -> PosedScene:
    """The scene with every bone where it truly was; only the bones, which is all that hulls follow."""
    actors = {actor.name: actor for actor in twin.performance.actors}
    moment = int(twin.truth.source_frame[np.searchsorted(twin.truth.frame, frame)])
    rest = setup.scene.pose_at(setup.scene.rest_pose())
    return replace(rest, Ms=np.concatenate([actors[name].Ms[moment] for name in setup.names]))

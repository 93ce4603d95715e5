"""The pose of a scene that was rendered, and poses that are off by a known amount."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from benchmarks.studies.twin_runs import Twin
from tracker.fitting.setup import TrackSetup
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.point_point import PointToPoint

Array = npt.NDArray[np.float64]

ITERATIONS = 30
"""Correspondences are exact, so that Gauss-Newton converges in far fewer from anywhere."""


def find_true_pose(twin: Twin, setup: TrackSetup, frame: int) -> Array:
    """(D,) the pose whose vertices are those that were rendered; the motions' own parameters are not in their files."""
    moment = int(twin.truth.source_frame[frame])
    scene = setup.scene
    actors = {actor.name: actor for actor in twin.performance.actors}
    targets = np.concatenate([actors[name].vertices(moment) for name in setup.names])
    pose = scene.rest_pose()
    for name, where in zip(setup.names, scene.pose_slices, strict=True):
        pose[where.start : where.start + 6] = se3.log(actors[name].T_world_model(moment))
    ids = np.repeat(np.arange(len(targets), dtype=np.int32)[:, None], 3, axis=1)
    shares = np.tile([1.0, 0.0, 0.0], (len(targets), 1))
    residual = PointToPoint(ids, shares, targets, np.ones(len(targets)))
    limits = np.full(scene.num_dofs, 0.4)
    for _ in range(ITERATIONS):
        equations = NormalEquations.at(scene.pose_at(pose))
        residual.add_to(equations)
        JtJ, Jtr = equations.assemble()
        pose = scene.retract(pose, compute_damped_step(JtJ, Jtr, 1e-6, limits))
    return pose


def disturb_hands(
    scene: Scene, pose: Array, rng: np.random.Generator, angle: float = np.deg2rad(15.0), shift: float = 0.010
) -> Array:
    """(D,) a pose with every hand off: each joint by `angle`, rad, to either side, its root by as much about some axis
    and by `shift`, m, in some direction; objects stay."""
    step = np.zeros(scene.num_dofs)
    for model, where in zip(scene.models, scene.pose_slices, strict=True):
        if model.hand:
            step[where.start : where.start + 3] = shift * _direction(rng)
            step[where.start + 3 : where.start + 6] = angle * _direction(rng)
            step[where.start + 6 : where.stop] = angle * rng.choice([-1.0, 1.0], where.stop - where.start - 6)
    return scene.retract(pose, step)


def _direction(rng: np.random.Generator) -> Array:
    direction = rng.normal(size=3)
    return direction / np.linalg.norm(direction)

"""Search for the pose of a scene with a swarm, whatever says how good a pose is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from benchmarks.baselines.swarm import Bounds, Found, search_with_swarm
from benchmarks.baselines.swarm_options import SwarmOptions
from tracker.model.scene import Scene

Array = npt.NDArray[np.float64]


def search_pose(
    scene: Scene,
    cost: Callable[[Array], float],
    start: Array,
    options: SwarmOptions,
    rng: np.random.Generator,
    deadline: float | None = None,
) -> tuple[Array, Found]:
    """The pose (D,) within the joint limits that a swarm around the pose `start` finds.

    Args:
        scene: Whose pose.
        cost: Of a pose (D,).
        start: (D,).
        options: Of the swarm.
        rng: Where chance comes from.
        deadline: As in `search_with_swarm`.
    """
    bounds = _bounds(scene, options, start)
    center = np.where(_is_root(scene), 0.0, start)
    found = search_with_swarm(lambda place: cost(_pose_at(scene, start, place)), center, bounds, options, rng, deadline)
    return _pose_at(scene, start, found.place), found


def _is_root(scene: Scene) -> npt.NDArray[np.bool_]:
    is_root = np.ones(scene.num_dofs, dtype=np.bool_)
    is_root[scene.angle_dofs] = False
    return is_root


def _pose_at(scene: Scene, start: Array, place: Array) -> Array:
    """The pose (D,) of a place (D,): roots are increments to those of `start`, joint angles are themselves."""
    angles = scene.angle_dofs
    step = place.copy()
    step[angles] = 0.0
    pose = scene.retract(start, step)
    pose[angles] = place[angles]
    return pose


def _bounds(scene: Scene, options: SwarmOptions, start: Array) -> Bounds:
    """Joint limits for angles, and the reach around `start` for roots and for angles without limits."""
    reach, spread = np.full(scene.num_dofs, options.reach_turn), np.full(scene.num_dofs, options.spread_angle)
    for where in scene.pose_slices:
        reach[where.start : where.start + 3] = options.reach_shift
        spread[where.start : where.start + 3] = options.spread_shift
        spread[where.start + 3 : where.start + 6] = options.spread_turn
    center = np.where(_is_root(scene), 0.0, start)
    lower = np.where(np.isfinite(scene.lower), scene.lower, center - reach)
    upper = np.where(np.isfinite(scene.upper), scene.upper, center + reach)
    return Bounds(lower, upper, spread, scene.angle_dofs)

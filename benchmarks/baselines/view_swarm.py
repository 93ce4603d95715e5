"""Find a scene in the colour images of one moment with the particle swarm: [T16] §4.4.1."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from benchmarks.baselines.joint_rays import JointRays
from benchmarks.baselines.pose_search import search_pose
from benchmarks.baselines.skin_view import see_skin
from benchmarks.baselines.swarm_options import SwarmOptions
from benchmarks.baselines.view_discrepancy import ViewDiscrepancy
from tracker.capture.frame import CameraFrame
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import ViewHands

Array = npt.NDArray[np.float64]


def search_views(
    setup: TrackSetup, seen: ViewHands, views: Sequence[CameraFrame], start: Array, options: SwarmOptions
) -> Array:
    """The pose (D,) that a swarm around the pose `start` finds; `start` itself where no view shows the scene.

    All models are searched together, in one swarm over all of their degrees of freedom.

    Args:
        setup: Models and their names.
        seen: Joints detected in the images; may be none.
        views: Cameras and images of one moment.
        start: (D,) of the frame before.
        options: Of the swarm; `side` is of each view.
    """
    scene, expected = setup.scene, setup.scene.pose_at(start).vertices
    shown = [own for own in (see_skin(view, expected, options.side) for view in views) if own is not None]
    if not shown:
        return start
    cost = ViewDiscrepancy(scene, shown, JointRays.of(scene, seen, setup.names))
    rng = np.random.default_rng((options.seed, views[0].frame.index))
    return search_pose(scene, cost, start, options, rng)[0]

"""Begin a run in colour views: the hands' shapes, fitted to the first seconds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tracker.capture.sequence import Sequence
from tracker.fitting.calibration import CalibrationFrame, calibrate_shapes
from tracker.fitting.setup import TrackSetup
from tracker.model.articulated import ArticulatedModel
from tracker.search.tools import make_tools
from tracker.tracking.fit_views import compose_near
from tracker.tracking.follow_views import follow_views
from tracker.tracking.state import TrackState

Progress = Callable[[str, float], None]

LOOKED_THROUGH = 60
"""Frames from which those are chosen that the shapes are fitted to; two seconds show several bends."""

CALIBRATED = 10
"""So many of them are enough."""


def start_views(
    sequence: Sequence, setup: TrackSetup, frames: range, progress: Progress
) -> tuple[TrackSetup, TrackState]:
    """The setup with fitted shapes, and a state in which all hands are yet to be found, as after they were lost.

    Where hardly any frame shows the hands in two views, or one view is all there is, they keep their default shapes.
    """
    pose = np.zeros(setup.scene.num_dofs)
    nowhere = TrackState(frames[0], pose, pose, is_lost=True)
    has_shapes = any(model.hand and model.shape for model in setup.models)
    if not setup.options.calibrate or len(setup.view_ids) < 2 or not has_shapes:
        return setup, nowhere
    return replace(setup, models=_calibrate(sequence, setup, frames[:LOOKED_THROUGH], nowhere, progress)), nowhere


def _calibrate(
    sequence: Sequence, setup: TrackSetup, frames: range, state: TrackState, progress: Progress
) -> tuple[ArticulatedModel, ...]:
    """The models with shapes that explain the joints of all views in some of the frames."""
    held = []
    with make_tools(setup, np.eye(4)) as tools:
        for index in frames:
            progress("fitting the hand's shape", (index - frames[0]) / (len(frames) + CALIBRATED))
            state, result, seen = follow_views(sequence, setup, tools, state)
            if result.status == "ok" and all(seen.count(name) > 1 for name in setup.hand_names):
                held.append((index, result.pose, seen))
        if not held:
            return setup.models
        chosen = []
        for place in np.linspace(0, len(held) - 1, min(CALIBRATED, len(held))):
            index, pose, seen = held[round(place)]
            views = setup.read_views(sequence, index)
            objective = compose_near(tools.objective, setup, seen, views, setup.scene.pose_at(pose))
            chosen.append(CalibrationFrame(None, pose, objective=objective))
        return calibrate_shapes(setup.scene, chosen).models

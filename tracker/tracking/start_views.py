"""Begin a run in colour views: the hands' shapes, fitted to the first seconds."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.fitting.calibration import CalibrationFrame, calibrate_shapes
from tracker.fitting.setup import TrackSetup
from tracker.model.articulated import ArticulatedModel
from tracker.search.start_object import place_object
from tracker.search.tools import make_tools
from tracker.tracking.fit_views import add_contours, compose_near
from tracker.tracking.follow_views import follow_views
from tracker.tracking.state import TrackState

log = logging.getLogger(__name__)

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

LOOKED_THROUGH = 60
"""Frames from which those are chosen that the shapes are fitted to; two seconds show several bends."""

CALIBRATED = 10
"""So many of them are enough."""


def start_views(
    sequence: Sequence, setup: TrackSetup, frames: range, progress: Progress
) -> tuple[TrackSetup, TrackState]:
    """The setup with fitted shapes, and a state in which all hands are yet to be found, as after they were lost.

    Objects start where the recording says that they were in its first frame; one of which it says nothing is left out.

    Where hardly any frame shows the hands in two views, or one view is all there is, they keep their default shapes.
    """
    setup, pose = _place_objects(sequence, setup)
    nowhere = TrackState(frames[0], pose, pose, is_lost=True)
    has_shapes = any(model.hand and model.shape for model in setup.models)
    if not setup.options.calibrate or len(setup.view_ids) < 2 or not has_shapes:
        return setup, nowhere
    return replace(setup, models=_calibrate(sequence, setup, frames[:LOOKED_THROUGH], nowhere, progress)), nowhere


def _place_objects(sequence: Sequence, setup: TrackSetup) -> tuple[TrackSetup, Array]:
    """The setup with hands and those objects that somebody placed, and its pose (D,) with the hands nowhere."""
    hands = [index for index, model in enumerate(setup.models) if model.hand]
    names, models = [setup.names[index] for index in hands], [setup.models[index] for index in hands]
    poses = [np.zeros(model.num_dofs) for model in models]
    items = {item.name: item for item in sequence.objects}
    for name, model in zip(setup.names, setup.models, strict=True):
        if model.hand:
            continue
        if items[name].T_world_object is None:
            log.warning(
                "%s: left out. In colour views objects are not looked for; needed `initial.T_world_object` in "
                "sequence.json.",
                name,
            )
            continue
        names.append(name)
        models.append(model)
        poses.append(place_object(model, items[name]))
    return replace(setup, names=tuple(names), models=tuple(models)), np.concatenate(poses)


def _calibrate(
    sequence: Sequence, setup: TrackSetup, frames: range, state: TrackState, progress: Progress
) -> tuple[ArticulatedModel, ...]:
    """The models with shapes that explain the joints and the contours of all views in some of the frames."""
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
            posed = setup.scene.pose_at(pose)
            objective = add_contours(compose_near(tools.objective, setup, seen, views, posed), posed, views)
            chosen.append(CalibrationFrame(None, pose, objective=objective))
        return calibrate_shapes(setup.scene, chosen).models

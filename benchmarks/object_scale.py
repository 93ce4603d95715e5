"""Measure how large an object is, whose mesh has the right form only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.errors import TrackingError
from tracker.model.articulated import ArticulatedModel
from tracker.observation import Preprocessing
from tracker.search.find_object import ObjectSearch, find_object

Array = npt.NDArray[np.float64]

SCALES: tuple[float, ...] = tuple(np.geomspace(0.7, 1.4, 15))

NEARBY = ObjectSearch(places=3, rotations=24, hypotheses=60, rough=3, fine=1)


@dataclass(frozen=True)
class ScaleView:
    """A frame to measure in.

    Attributes:
        frame: Undistorted.
        camera: Its camera.
        others: Models that are placed in it, with their poses (D,).
    """

    frame: Frame
    camera: Camera
    others: list[tuple[ArticulatedModel, Array]]


def with_scale(model: ArticulatedModel, scale: float) -> ArticulatedModel:
    """The model with all its lengths times `scale`, about the origin of its file's coordinates."""
    assert model.hand is None, "hands have a shape, not a scale"
    assert scale > 0.0
    Ts = model.skeleton.Ts_model_bone.copy()
    Ts[:, :3, 3] *= scale
    return replace(
        model,
        vertices=model.vertices * scale,
        skeleton=replace(model.skeleton, Ts_model_bone=Ts),
        provenance={**model.provenance, "scale": f"{scale:.4g}"},
    )


def find_scale(
    model: ArticulatedModel, views: Sequence[ScaleView], how: Preprocessing, scales: Sequence[float] = SCALES
) -> float:
    """The scale at which an object explains some frames best.

    It is looked for everywhere in the size of its mesh, and near where it was in the other scales; the mean score, in
    which the outline counts as the depth does, has its highest value at the true size. A parabola through that and its
    neighbours gives the scale between those tried.

    Args:
        model: The object in a size that is off by no more than `scales` span.
        views: A few frames that show it well.
        how: Preprocessing.
        scales: Rising.

    Raises:
        TrackingError: The object is in none of the frames, or its size is not within the scales.
    """
    assert len(scales) >= 3 and views
    scores = np.zeros((len(views), len(scales)))
    for row, view in zip(scores, views, strict=True):
        place = find_object(model, view.frame, view.camera, how, view.others)
        if place is None:
            continue
        for column, scale in enumerate(scales):
            sized = with_scale(model, float(scale))
            found = find_object(sized, view.frame, view.camera, how, view.others, place.pose, NEARBY)
            row[column] = 0.0 if found is None else found.quality.score
    scores = scores.mean(axis=0)
    best = int(np.argmax(scores))
    if scores[best] <= 0.0 or best in (0, len(scales) - 1):
        raise TrackingError(
            f"{model.name}: its size was not found between {scales[0]:.2f} and {scales[-1]:.2f} times that of its mesh "
            f"(best score {scores[best]:.2f} at {scales[best]:.2f}); needed a mesh nearer in size, or frames that show "
            "the object."
        )
    logs = np.log(np.asarray(scales[best - 1 : best + 2], dtype=np.float64))
    a, b, _ = np.polyfit(logs - logs[1], scores[best - 1 : best + 2], 2)
    return float(np.exp(logs[1] - 0.5 * b / a)) if a < 0.0 else float(scales[best])

"""Fingertips that the detector finds in a frame, as people look at them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.detection import Detection, assign_detections
from tracker.geometry import se3
from tracker.model.joints import FINGERS
from tracker.model.scene import PosedScene
from tracker.rendering import View
from tracker.terms.salient import Salient

Points = npt.NDArray[np.float32]


@dataclass(frozen=True)
class ShownDetection:
    """One detection δ_s of [T16] §3.2.5 and the fingertip φ_t that Eq. 14 makes of it.

    Attributes:
        position: (3,) the centroid of its points, world, m.
        box: (4, 3) corners of its box in the image at its depth, in turn, world, m.
        confidence: c_s; 3.0 and more are used.
        model: Index of the hand it was assigned to; -1 for a false positive.
        finger: Index into FINGERS, -1 likewise.
        tip: (3,) centroid of that fingertip's visible vertices, world, m; its own position where there is none.
    """

    position: Points
    box: Points
    confidence: float
    model: int
    finger: int
    tip: Points

    @property
    def finger_name(self) -> str:
        """`thumb`..`little`, or empty."""
        return FINGERS[self.finger] if self.finger >= 0 else ""

    @property
    def distance(self) -> float:
        """From the fingertip, m; 0 where there is none."""
        return float(np.linalg.norm(self.tip - self.position))


def show_detections(
    posed: PosedScene, view: View, detections: tuple[Detection, ...], T_world_camera: npt.NDArray[np.float64]
) -> tuple[ShownDetection, ...]:
    """Every detection with the fingertip it belongs to at this pose, most confident first.

    Args:
        posed: The scene.
        view: The same, drawn.
        detections: Of the frame.
        T_world_camera: (4, 4) of the depth camera.
    """
    salient = Salient(detections)
    fingertips = salient.find_fingertips(posed, view)
    centroids = np.array([item.centroid for item in detections]).reshape(-1, 3)
    distances = np.linalg.norm(centroids[:, None] - fingertips.centroids[None], axis=2)
    assigned = assign_detections(distances, np.ones(len(detections)), salient.rejection)
    shown = []
    for detection, place in zip(detections, assigned, strict=True):
        model, finger, tip = -1, -1, detection.centroid
        if place >= 0:
            model, finger = _find_owner(posed, int(fingertips.vertices[place][0]))
            tip = fingertips.centroids[place]
        left, top, right, bottom = detection.box_rays
        rays = np.array([[left, top, 1.0], [right, top, 1.0], [right, bottom, 1.0], [left, bottom, 1.0]])
        shown.append(
            ShownDetection(
                detection.centroid.astype(np.float32),
                se3.transform(T_world_camera, detection.depth * rays).astype(np.float32),
                detection.confidence,
                model,
                finger,
                tip.astype(np.float32),
            )
        )
    return tuple(shown)


def _find_owner(posed: PosedScene, vertex: int) -> tuple[int, int]:
    """Model and finger whose fingertip a vertex of the scene belongs to."""
    for index, (model, where) in enumerate(zip(posed.scene.models, posed.scene.vertex_slices, strict=True)):
        for finger, ids in enumerate(model.hand.fingertips if model.hand else ()):
            if np.any(ids + where.start == vertex):
                return index, finger
    raise AssertionError("a fingertip's vertex belongs to a finger")

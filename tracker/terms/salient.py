"""Fingertips that a detector found, [T16] §3.2.5, Eq. 14 and 15."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.detection.assignment import assign_detections
from tracker.detection.confidence import C_THR
from tracker.detection.detection import Detection
from tracker.model.scene import PosedScene
from tracker.rendering import View
from tracker.terms.look import TermLook
from tracker.terms.nearby_pixels import find_vertex_pixel
from tracker.terms.point_point import PointToPoint
from tracker.terms.residual import FrameContext

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Fingertips:
    """The model's fingertips φ_t that can be seen.

    Attributes:
        vertices: For each its vertices that count, in the scene.
        centroids: (T, 3) their mean, world, m.
    """

    vertices: tuple[Ints, ...]
    centroids: Array


@dataclass(frozen=True)
class Salient:
    """Pull fingertips to the detections that are assigned to them: E = Σ e_st Σ |v_i − X_i|², [T16] Eq. 15.

    Which detection δ_s is which fingertip φ_t is decided at every look for correspondences by Eq. 14. A pair nearer
    than `near` gives no correspondences. Otherwise each visible vertex of the fingertip goes to the closest point of
    the detection, or, where less than half of them project inside its box, all go to its centroid.

    Differs from the paper: λ. The paper gives numbers without a unit; its Table 3, where λ = 0.3 changes nothing, fits
    centimetres, in which pairs up to λ (1 + w_s) = 2.4 cm are accepted at its λ = 1.2. Our detections are more
    trustworthy than its depth detector's, so more is accepted.
    """

    look: ClassVar[TermLook] = TermLook("salient", "Salient", "#ffffff", "#5a3ca5", (6, 3))

    detections: tuple[Detection, ...] = ()
    """δ_s of this frame; those below `min_confidence` are left out."""

    weight: float = 1.0
    """Eq. 5 gives this term weight one."""

    rejection: float = 0.025
    """λ, m: the cost of a fingertip without a detection and, times w_s, of a false positive. 0 turns the term off."""

    use_confidence: bool = False
    """w_s = c_s / c_thr instead of w_s = 1."""

    min_confidence: float = C_THR
    """c_thr, §3.2.5."""

    near: float = 0.010
    """m (10 mm, §3.2.5)."""

    visible_within: float = 0.003
    """A vertex is visible when it is at most this far behind the rendered surface, m."""

    hidden_fingertips: bool = False
    """Fingertips without a visible vertex take part with all their vertices; useful for hands that are lost."""

    def find(self, posed: PosedScene, context: FrameContext) -> PointToPoint:
        """Assign detections and make their correspondences."""
        ids, targets = [np.zeros(0, dtype=np.int64)], [np.zeros((0, 3))]
        for detection, fingertip in self.assign(posed, context.view):
            found = self._targets(posed, context.view, detection, fingertip)
            ids.append(fingertip)
            targets.append(found)
        return PointToPoint.of_vertices(np.concatenate(ids), np.concatenate(targets), self.weight)

    def assign(self, posed: PosedScene, view: View) -> list[tuple[Detection, Ints]]:
        """Detections with the vertices (n,) of the fingertip each belongs to; pairs near enough are left out."""
        detections = [item for item in self.detections if item.confidence >= self.min_confidence]
        fingertips = self.find_fingertips(posed, view)
        if not detections or not fingertips.vertices:
            return []
        centroids = np.stack([item.centroid for item in detections])
        distances = np.linalg.norm(centroids[:, None] - fingertips.centroids[None], axis=2)
        weights = np.ones(len(detections))
        if self.use_confidence:
            weights = np.array([item.confidence for item in detections]) / self.min_confidence
        found = assign_detections(distances, weights, self.rejection)
        return [
            (detections[s], fingertips.vertices[t])
            for s, t in enumerate(found)
            if t >= 0 and distances[s, t] >= self.near
        ]

    def find_fingertips(self, posed: PosedScene, view: View) -> Fingertips:
        """The fingertips of all hands of the scene that are seen."""
        scene = posed.scene
        vertices, centroids = [], []
        for model, where in zip(scene.models, scene.vertex_slices, strict=True):
            if model.hand is None:
                continue
            for fingertip in model.hand.fingertips:
                own = np.asarray(fingertip, dtype=np.int64) + where.start
                visible = own[_is_visible(view.projected, view.inverse_depth, own, self.visible_within)]
                if len(visible) == 0 and self.hidden_fingertips:
                    visible = own
                if len(visible):
                    vertices.append(visible)
                    centroids.append(posed.vertices[visible].mean(axis=0))
        return Fingertips(tuple(vertices), np.array(centroids).reshape(-1, 3))

    def _targets(self, posed: PosedScene, view: View, detection: Detection, fingertip: Ints) -> Array:
        """(n, 3) where the vertices of a fingertip should be, world, m."""
        K, projected = view.K, view.projected[fingertip]
        rays = (projected[:, :2] - K[[0, 1], 2]) / K[[0, 1], [0, 1]]
        box = detection.box_rays
        inside = (projected[:, 2] > 0.0) & np.all((rays >= box[:2]) & (rays <= box[2:]), axis=1)
        if 2 * np.count_nonzero(inside) < len(fingertip):
            return np.repeat(detection.centroid[None], len(fingertip), axis=0)
        return detection.points[_find_closest(posed.vertices, fingertip, detection.points)]


@njit(cache=True, nogil=True)
def _is_visible(projected, inverse_depth, vertices, within):
    height, width = inverse_depth.shape
    result = np.zeros(len(vertices), dtype=np.bool_)
    for n in range(len(vertices)):
        row, column = find_vertex_pixel(projected, vertices[n], height, width)
        if row >= 0:
            drawn = inverse_depth[row, column]
            result[n] = drawn <= 0.0 or 1.0 / projected[vertices[n], 2] <= 1.0 / drawn + within
    return result


@njit(cache=True, nogil=True)
def _find_closest(positions, vertices, points):
    """(n,) the point nearest to each vertex; the first of equally near ones."""
    result = np.zeros(len(vertices), dtype=np.int64)
    for n in range(len(vertices)):
        best = np.inf
        for p in range(len(points)):
            dx = points[p, 0] - positions[vertices[n], 0]
            dy = points[p, 1] - positions[vertices[n], 1]
            dz = points[p, 2] - positions[vertices[n], 2]
            distance = dx * dx + dy * dy + dz * dz
            if distance < best:
                best = distance
                result[n] = p
    return result

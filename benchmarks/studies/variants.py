"""Terms that only studies use: what T16 tried and found worse, and what it does in every frame."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tracker.detection import Detection, Forest, find_fingertips
from tracker.model.scene import PosedScene
from tracker.observation import Observation
from tracker.terms.colliding_parts import find_crossings
from tracker.terms.point_plane import PointToPlane
from tracker.terms.point_point import PointToPoint
from tracker.terms.residual import FrameContext, Residual, Term
from tracker.terms.salient import Salient


@dataclass(frozen=True)
class AsPoints:
    """A term whose planes are points: [T16] Eq. 6 in place of Eq. 7, with the same correspondences."""

    term: Term

    @property
    def weight(self) -> float:
        return self.term.weight

    def find(self, posed: PosedScene, context: FrameContext) -> Residual:
        found = self.term.find(posed, context)
        if not isinstance(found, PointToPlane):
            return found
        return PointToPoint(found.ids, found.barycentric, found.targets, found.weights)


@dataclass(frozen=True)
class CorrespondingVertices:
    """The simple repulsion of [T16] Table 5: vertices of colliding triangles move towards their counterpart.

    Each vertex of a crossing triangle goes to the nearest vertex of the triangle that it crosses, once, whatever the
    number of triangles it meets.
    """

    weight: float = 1.0

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToPoint:
        pairs, faces = find_crossings(posed).pairs, posed.scene.arrays.faces
        both = np.concatenate([pairs, pairs[:, ::-1]])
        own = faces[both[:, 0]].reshape(-1)
        others = posed.vertices[np.repeat(faces[both[:, 1]], 3, axis=0)]  # (N, 3, 3)
        distances = np.linalg.norm(others - posed.vertices[own][:, None], axis=2)
        nearest = np.argmin(distances, axis=1)
        rows = np.arange(len(own))
        order = np.lexsort((distances[rows, nearest], own))
        ids, first = np.unique(own[order], return_index=True)
        chosen = order[first]
        barycentric = np.zeros((len(ids), 3))
        barycentric[:, 0] = 1.0
        return PointToPoint(
            np.repeat(ids[:, None], 3, axis=1).astype(np.int32),
            barycentric,
            others[chosen, nearest[chosen]].reshape(-1, 3),
            np.full(len(ids), self.weight),
        )


@dataclass
class SalientInEveryFrame:
    """Fingertips in every frame and iteration, as T16 has them; detected once a frame.

    Our tracker asks for them only where a frame went badly (docs/objective.md).
    """

    detector: Forest
    salient: Salient
    _of: Observation | None = field(default=None, repr=False)
    _found: tuple[Detection, ...] = ()

    @property
    def weight(self) -> float:
        return self.salient.weight

    def find(self, posed: PosedScene, context: FrameContext) -> PointToPoint:
        if self._of is not context.observation:
            self._of, self._found = context.observation, tuple(find_fingertips(self.detector, context.observation))
        own = self.salient
        return Salient(self._found, own.weight, own.rejection, own.use_confidence).find(posed, context)

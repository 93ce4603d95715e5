"""Residual kind: distance of a surface point from a point, r = v − X, [T16] Eq. 6."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.scene import PosedScene
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.point_plane import PointToPlane
from tracker.terms.residual import ResidualBlock
from tracker.terms.surface_rows import SurfaceRows, span

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PointToPoint(SurfaceRows):
    """Surface points and the points they should meet: three planes each.

    Attributes:
        targets: (N, 3) world, m.
        weights: (N,).
    """

    targets: Array
    weights: Array

    @classmethod
    def of_vertices(cls, vertices: npt.NDArray[np.integer], targets: Array, weight: float = 1.0) -> PointToPoint:
        """Vertices (N,) that should meet targets (N, 3) world, m."""
        return cls(*span(vertices), targets, np.full(len(vertices), weight))

    @property
    def weight(self) -> float:
        """Each correspondence has its own."""
        return 1.0

    def find(self, posed: PosedScene, context: object = None) -> PointToPoint:
        """As a term: these correspondences, at every pose."""
        return self

    def as_planes(self) -> PointToPlane:
        """The same sum of squares as planes across x, y and z."""
        return PointToPlane(
            np.repeat(self.ids, 3, axis=0),
            np.repeat(self.barycentric, 3, axis=0),
            np.repeat(self.targets, 3, axis=0),
            np.tile(np.eye(3), (self.count, 1)),
            np.repeat(self.weights, 3),
        )

    def linearize(self, posed: PosedScene) -> ResidualBlock:
        return self.as_planes().linearize(posed)

    def add_to(self, equations: NormalEquations) -> None:
        self.as_planes().add_to(equations)
        equations.count -= 2 * self.count  # a correspondence counts once, whatever its rows

    def segments(self, posed: PosedScene) -> Array:
        return np.stack([self.points(posed), self.targets], axis=1)

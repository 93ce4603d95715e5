"""What the residual kinds share: points of a surface, each the share of three vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.scene import PosedScene

Array = npt.NDArray[np.float64]
Ids = npt.NDArray[np.int32]


@dataclass(frozen=True)
class SurfaceRows:
    """Surface points.

    Attributes:
        ids: (N, 3) vertices that span each surface point.
        barycentric: (N, 3) their shares.
    """

    ids: Ids
    barycentric: Array

    @property
    def count(self) -> int:
        return len(self.ids)

    def points(self, posed: PosedScene) -> Array:
        """(N, 3) the surface points, world, m."""
        return np.einsum("nc,nci->ni", self.barycentric, posed.vertices[self.ids])


def span(vertices: npt.NDArray[np.integer]) -> tuple[Ids, Array]:
    """Vertices (N,) as surface points: ids (N, 3) and shares (N, 3)."""
    ids = np.repeat(np.asarray(vertices, dtype=np.int32)[:, None], 3, axis=1)
    return ids, np.tile([1.0, 0.0, 0.0], (len(ids), 1))

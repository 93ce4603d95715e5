"""What the kernels of the terms read: a scene as it is drawn, and what was seen in the same pixels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class DrawnFrame(NamedTuple):
    """Arrays of a drawn scene and of an observation, for compiled code.

    Attributes:
        faces: (F, 3) vertex ids.
        face_labels: (F,) label bits that a face may match.
        face_normals: (F, 3) unit, world.
        vertices: (V, 3) world, m; landmarks are the last of them.
        vertex_normals: (V, 3) unit, world; 0 for landmarks.
        vertex_labels: (V,) label bits that a vertex may match.
        is_palm: (V,) whether a vertex follows the root of a hand most.
        projected: (V, 3) column px, row px, inverse depth 1/m (0 = not in front).
        inverse_depth: (H, W) drawn, 1/m, 0 where nothing is.
        face: (H, W) drawn face, -1 where nothing is.
        points: (H, W, 3) seen, world, m.
        normals: (H, W, 3) seen, unit, world; 0 where there is none.
        depth: (H, W) seen, m.
        labels: (H, W) label bits seen; 0 where nothing of the scene can be.
        edges: (2, H, W) whether a pixel is a discontinuity of what was seen, of hands and of other things.
        nearest: (2, H, W, 2) row and column of the nearest pixel with a label, of hands and of other things.
        K: (3, 3) px.
        T: (4, 4) from the camera to the world.
    """

    faces: npt.NDArray[np.int32]
    face_labels: npt.NDArray[np.uint8]
    face_normals: Array
    vertices: Array
    vertex_normals: Array
    vertex_labels: npt.NDArray[np.uint8]
    is_palm: npt.NDArray[np.bool_]
    projected: Array
    inverse_depth: Array
    face: npt.NDArray[np.int32]
    points: npt.NDArray[np.float32]
    normals: npt.NDArray[np.float32]
    depth: npt.NDArray[np.float32]
    labels: npt.NDArray[np.uint8]
    edges: npt.NDArray[np.uint8]
    nearest: npt.NDArray[np.int16]
    K: Array
    T: Array


class Matches(NamedTuple):
    """Room for correspondences of surface points; a kernel fills the first rows and says how many.

    Attributes:
        ids: (N, 3) vertices that span each surface point.
        barycentric: (N, 3) their shares.
        targets: (N, 3) a point of each plane, or the moment of each line, world, m.
        directions: (N, 3) unit, world: of each plane's normal, or of each line.
    """

    ids: npt.NDArray[np.int32]
    barycentric: Array
    targets: Array
    directions: Array

    @classmethod
    def room(cls, count: int) -> Matches:
        """For so many at most."""
        return cls(np.empty((count, 3), np.int32), np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3)))

    def first(self, count: int) -> tuple[npt.NDArray[np.int32], Array, Array, Array]:
        """Only the rows that were filled."""
        return self.ids[:count], self.barycentric[:count], self.targets[:count], self.directions[:count]

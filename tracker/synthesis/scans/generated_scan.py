"""One scan with its truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class HandTruth:
    """A hand as it is, in the coordinates of its scan, m; of a left hand the left hand.

    Attributes:
        vertices: (V, 3) of the untrained hand's topology.
        surface: (W, 3) vertices of the surface that was scanned.
        surface_faces: (F, 3), outwards.
        joints: (16, 3) in the order of `BlendModel`.
        subject: Number of the subject.
        pose_name: As in the list of poses.
        side: "right" or "left".
    """

    vertices: Array
    surface: Array
    surface_faces: Ints
    joints: Array
    subject: int
    pose_name: str
    side: str


@dataclass(frozen=True)
class GeneratedScan:
    """A scan and what it is a scan of.

    Attributes:
        scan: In metres, in coordinates of its own.
        true_vertices: (V, 3) m in the topology of the untrained hand of this side.
        true_surface: Vertices (W, 3) and faces (F, 3) of the surface that was scanned.
        joints: (16, 3) m in the order of `BlendModel`.
        is_hand: (N,) which points are on the hand: not on the forearm beyond the untrained hand's and not on an object.
        subject: 1 to 37.
        pose_name: As in the list of poses, or "given".
        side: "right" or "left".
    """

    scan: Scan
    true_vertices: Array
    true_surface: tuple[Array, Ints]
    joints: Array
    is_hand: npt.NDArray[np.bool_]
    subject: int
    pose_name: str
    side: str

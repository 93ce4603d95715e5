"""Keep joints on the viewing rays of their places in an image: those that somebody marked, or that a detector found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.model.scene import PosedScene, Scene
from tracker.terms.look import TermLook
from tracker.terms.point_line import PointToLine, find_slack
from tracker.terms.residual import FrameContext
from tracker.terms.surface_rows import span

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class MarkedJoints:
    """Keep landmarks on rays: E = Σ wᵢ ρ(|v × d − m|), as [T16] Eq. 8 measures the distance.

    Where `reach` is finite the weight of a ray falls with its distance from the joint (`find_slack`).

    Attributes:
        ids: (N,) vertices of the scene.
        directions: (N, 3) unit, world.
        moments: (N, 3) world, m.
        beliefs: (N,) 0 to 1, how much each joint is believed.
        weight: Of a joint that is believed; an annotator's pixel is about a millimetre.
        reach: mm.
    """

    look: ClassVar[TermLook] = TermLook("joints", "Joints", "#967887", "#001e3c", (12, 4))

    ids: npt.NDArray[np.int32]
    directions: Array
    moments: Array
    beliefs: Array
    weight: float = 1.0
    reach: float = np.inf

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToLine:
        """The same rays whatever the pose, with less weight where the joint is far from its own."""
        slack = find_slack(posed.vertices[self.ids], self.directions, self.moments, self.reach)
        weights = self.weight * self.beliefs / slack
        return PointToLine(*span(self.ids), self.directions, self.moments, weights)


def mark_joints(
    scene: Scene, model: int, points: Array, camera: Camera, beliefs: Array | None = None, reach: float = np.inf
) -> MarkedJoints:
    """Rays of the marked joints of one hand.

    Args:
        scene: The scene.
        model: Which of its models is the hand.
        points: (21, 3) x, y px and v (0 absent, 1 occluded, 2 visible).
        camera: Undistorted camera.
        beliefs: (21,) 0 to 1, how much each joint is believed; 1 when left out.
        reach: mm; how far from its joint a ray still pulls.
    """
    marked = np.flatnonzero(points[:, 2] > 0)
    directions = find_rays(points[marked], camera)
    origin = camera.T_world_camera[:3, 3]
    ids = np.arange(scene.landmark_slices[model].start, scene.landmark_slices[model].stop, dtype=np.int32)[marked]
    moments = np.cross(np.broadcast_to(origin, directions.shape), directions)
    own = np.ones(len(ids)) if beliefs is None else beliefs[marked]
    return MarkedJoints(ids, directions, moments, own, reach=reach)


def find_rays(points: Array, camera: Camera) -> Array:
    """(N, 3) unit viewing rays, world, of pixels (N, 2 or more)."""
    x, y = (points[:, 0] - camera.K[0, 2]) / camera.K[0, 0], (points[:, 1] - camera.K[1, 2]) / camera.K[1, 1]
    rays = np.stack([x, y, np.ones_like(x)], axis=1) @ camera.T_world_camera[:3, :3].T
    return rays / np.linalg.norm(rays, axis=1, keepdims=True)

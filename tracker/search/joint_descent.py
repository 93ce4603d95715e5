"""From the places of a hand's joints to its pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.terms.joint_prior import AnatomicalLimits, Regularization
from tracker.terms.marked_joints import MarkedJoints
from tracker.terms.point_point import PointToPoint

Array = npt.NDArray[np.float64]

BENDS = (0.0, 0.35, 0.7)
"""Of all fingers, shares of their range, from which a descent begins."""

FEW_STEPS = 5
"""So many steps from each bend tell which of them leads to the joints."""


@dataclass(frozen=True)
class JointDescent:
    """Gauss-Newton on rays, places in space, limits and nearness to a pose at rest.

    Attributes:
        scene: One hand.
        joints: Rays on which joints lie.
        places: (21, 3) joints in space, world, m.
        is_placed: (21,) which of them are known well enough to pull.
    """

    scene: Scene
    joints: MarkedJoints
    places: Array
    is_placed: npt.NDArray[np.bool_]

    def rest(self, angles: Array, known: npt.NDArray[np.bool_]) -> Array:
        """The pose (D,) of given angles (A,) whose joints come nearest to the places of those that are known (21,)."""
        rest = self.scene.rest_pose()
        rest[6:] = angles
        T = align(self.scene.pose_at(rest).landmarks(0)[known], self.places[known])
        rest[:6] = se3.log(T)
        return rest

    def descend(self, start: Array, rest: Array, iterations: int) -> tuple[Array, float]:
        """The pose (D,) after some steps from a start (D,), and its cost."""
        landmarks = self.scene.landmark_slices[0].start + np.flatnonzero(self.is_placed)
        depths = PointToPoint.of_vertices(landmarks, self.places[self.is_placed], 0.1)
        objective = Objective({"joints": self.joints, "depths": depths}, AnatomicalLimits(0.05), Regularization(2.0))
        fit = fit_frame(self.scene, None, start, rest, objective, FitOptions(iterations, max_turn=0.3))
        return fit.pose, sum(fit.costs[-1].values()) if fit.costs else np.inf


def align(source: Array, target: Array) -> Array:
    """Rigid motion (4, 4) that carries points (N, 3) nearest to others, by Kabsch's SVD."""
    center_source, center_target = source.mean(axis=0), target.mean(axis=0)
    U, _, Vt = np.linalg.svd((target - center_target).T @ (source - center_source))
    T = np.eye(4)
    T[:3, :3] = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
    T[:3, 3] = center_target - T[:3, :3] @ center_source
    return T

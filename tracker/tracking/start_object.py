"""Place an object where the recording says that it was in the first frame."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.recorded_object import RecordedObject
from tracker.errors import TrackingError
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.joint_prior import AnatomicalLimits, Regularization
from tracker.terms.point_point import PointToPoint
from tracker.tracking.objective import Objective

Array = npt.NDArray[np.float64]

ITERATIONS = 60


def place_object(model: ArticulatedModel, item: RecordedObject) -> Array:
    """(D,) pose of an object from its recorded root and, if it is articulated, its bones' positions.

    Raises:
        TrackingError: Nobody placed it, or no bone that was placed is the model's.
    """
    if item.T_world_object is None:
        raise TrackingError(
            f"{item.name}: nobody placed it in the first frame; needed `initial.T_world_object` in sequence.json."
        )
    scene = Scene((model,))
    pose = scene.rest_pose()
    pose[:6] = se3.log(item.T_world_object)
    bones = [bone for bone in model.skeleton.bone_names if bone in item.joints]
    if not item.joints or model.skeleton.num_bones == 1:
        return pose
    if not bones:
        raise TrackingError(f"{item.name}: bones {list(item.joints)[:3]}... are not the model's.")
    ids = scene.landmark_slices[0].start + np.array([model.skeleton.bone_names.index(bone) for bone in bones])
    corners = np.repeat(ids[:, None], 3, axis=1).astype(np.int32)
    shares = np.tile([1.0, 0.0, 0.0], (len(bones), 1))
    targets = np.array([item.joints[bone] for bone in bones])
    meet = PointToPoint(corners, shares, targets, np.ones(len(bones)))
    objective = Objective(terms={}, anatomy=AnatomicalLimits(1e-4), regularization=Regularization(1e-3))
    limits = np.full(scene.num_dofs, 0.3)
    for _ in range(ITERATIONS):
        posed = scene.pose_at(pose)
        JtJ, Jtr, _ = objective.linearize(posed, {"bones": meet}, pose)
        pose = scene.retract(pose, compute_damped_step(JtJ, Jtr, 1e-3, limits))
    return pose

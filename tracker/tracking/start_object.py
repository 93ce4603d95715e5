"""Place an object in the first frame: where the recording says that it was, or else where it is found."""

from __future__ import annotations

import logging

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.recorded_object import RecordedObject
from tracker.errors import TrackingError
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.observation import Preprocessing
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.joint_prior import AnatomicalLimits, Regularization
from tracker.terms.point_point import PointToPoint
from tracker.tracking.depth_range import depth_range
from tracker.tracking.find_object import find_object
from tracker.tracking.forearm import leave_out_forearms
from tracker.tracking.leave_out import leave_out
from tracker.tracking.objective import Objective

log = logging.getLogger(__name__)

Array = npt.NDArray[np.float64]

ITERATIONS = 60


def start_object(
    model: ArticulatedModel,
    item: RecordedObject,
    frame: Frame,
    camera: Camera,
    how: Preprocessing,
    others: list[tuple[ArticulatedModel, Array]],
) -> Array:
    """(D,) pose of an object in a frame: as recorded, or else the one that explains best what the others leave over.

    Where colour tells hands from other things, hands stay in the frame; otherwise what they explain is left out.

    Args:
        model: The object.
        item: What the recording says of it.
        frame: Undistorted first frame.
        camera: Its camera.
        how: Preprocessing.
        others: Models that are placed, with their poses (D,).

    Raises:
        TrackingError: It was not placed by anybody and is not found, or no bone that was placed is the model's.
    """
    if item.T_world_object is not None:
        return place_object(model, item)
    near, far = depth_range(frame)
    is_coloured = frame.color is not None and how.use_skin
    hands = [Scene((other,)).pose_at(pose).landmarks(0) for other, pose in others if other.hand]
    for other, pose in others:
        if not (other.hand and is_coloured):
            frame = leave_out(frame, camera, Scene((other,)), pose, [0])
    frame = leave_out_forearms(frame, camera, hands)
    found = find_object(frame, camera, model, how, near, far, np.concatenate(hands) if hands else None)
    if found is None or not found.is_believable:
        best = (
            "nothing is there that could be one"
            if found is None
            else f"{100.0 * found.quality.inside:.0f} % of what would be in sight of the best guess is there"
        )
        raise TrackingError(
            f"{item.name}: not found in frame {frame.index} of camera {frame.camera}: {best}. Needed: a first frame "
            "that shows most of it, its mesh in the right unit, or `initial.T_world_object` in sequence.json."
        )
    log.info(
        "%s: found in frame %d, %.1f mm from the depth at the median, %.0f %% of its outline as seen",
        item.name,
        frame.index,
        1e3 * found.quality.depth_residual,
        100.0 * found.quality.outline_iou,
    )
    return found.pose


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

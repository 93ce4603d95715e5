"""Place an object in the first frame: where the recording says that it was, or else where it is found."""

from __future__ import annotations

import logging
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.recorded_object import RecordedObject
from tracker.errors import TrackingError
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.observation import Preprocessing
from tracker.search.find_object import FoundObject, find_object
from tracker.terms.joint_prior import AnatomicalLimits, Regularization
from tracker.terms.point_point import PointToPoint

log = logging.getLogger(__name__)

Array = npt.NDArray[np.float64]

CLEAR = 0.75
"""An object found with a lower score may be another thing of about its size, or badly seen: a warning says so, as
it does where joints may have been bent to explain a part only."""


def start_object(
    model: ArticulatedModel,
    item: RecordedObject,
    frames: Iterable[tuple[Frame, Camera]],
    how: Preprocessing,
    others: list[tuple[ArticulatedModel, Array]],
) -> Array:
    """(D,) pose of an object as recorded, or else the one that explains best what the others leave over.

    An object that the first frame shows too badly, but one of the next ones well, starts from the best guess; it is
    lost as long as the frames do not bear that out, and found as any lost object is.

    Args:
        model: The object.
        item: What the recording says of it.
        frames: Undistorted frames in order, each with its camera; read only as far as needed.
        how: Preprocessing.
        others: Models that are placed, with their poses (D,) in the first frame.

    Raises:
        TrackingError: It was not placed by anybody and is not found, or no bone that was placed is the model's.
    """
    if item.T_world_object is not None:
        return place_object(model, item)
    guess: FoundObject | None = None
    looked_at = []
    for frame, camera in frames:
        # Hands are left out where they were in the first frame; later they have moved away from there.
        found = find_object(model, frame, camera, how, [] if looked_at else others)
        looked_at.append(frame.index)
        if found is None:
            continue
        guess = guess or found
        if not found.is_believable:
            continue
        is_clear = found.quality.score >= CLEAR and model.skeleton.num_bones == 1
        level = logging.INFO if is_clear else logging.WARNING
        log.log(level, "%s: found in frame %d, %s", item.name, frame.index, _describe(found))
        if guess is not found:
            log.warning("%s: frame %d shows it too badly: %s", item.name, looked_at[0], _describe(guess))
        return guess.pose
    best = "nothing there could be the object" if guess is None else f"at best {_describe(guess)}"
    raise TrackingError(
        f"{item.name}: not found in frames {', '.join(map(str, looked_at))}: {best}. Needed: a first second that shows "
        "most of it, its mesh in the right unit, or `initial.T_world_object` in sequence.json."
    )


def _describe(found: FoundObject) -> str:
    quality = found.quality
    return (
        f"{100.0 * found.in_sight:.0f} % in sight, {100.0 * quality.inside:.0f} % of that there, "
        f"{1e3 * quality.depth_residual:.1f} mm off at the median, {100.0 * quality.outline_iou:.0f} % of the outline "
        f"as seen, score {quality.score:.2f}"
    )


def place_object(model: ArticulatedModel, item: RecordedObject) -> Array:
    """(D,) pose of an object from its recorded root and, if it is articulated, its bones' positions.

    Raises:
        TrackingError: Nobody placed it, or no bone that was placed is the model's.
    """
    if item.T_world_object is None:
        raise TrackingError(
            f"{item.name}: it has no place in the first frame; needed `initial.T_world_object` in sequence.json."
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
    meet = PointToPoint.of_vertices(ids, np.array([item.joints[bone] for bone in bones]))
    objective = Objective({"bones": meet}, AnatomicalLimits(1e-4), Regularization(1e-6))
    return fit_frame(scene, None, pose, pose, objective, FitOptions(60, max_turn=0.3)).pose

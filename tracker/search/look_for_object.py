"""Look for an object in what the other models of a scene leave over of a frame."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.observation import Preprocessing
from tracker.search.depth_range import depth_range
from tracker.search.find_object import FoundObject, ObjectSearch, find_object
from tracker.search.forearm import leave_out_forearms
from tracker.search.leave_out import leave_out

Array = npt.NDArray[np.float64]


def look_for_object(
    model: ArticulatedModel,
    frame: Frame,
    camera: Camera,
    how: Preprocessing,
    others: list[tuple[ArticulatedModel, Array]],
    last: Array | None = None,
    search: ObjectSearch | None = None,
) -> FoundObject | None:
    """The best pose of an object in a frame, believable or not; None where there is nothing that could be one.

    Where colour tells hands from other things, hands stay in the frame; otherwise what they explain is left out, as is
    what other objects explain. Forearms, in sleeves or not, are always left out.

    Args:
        model: The object.
        frame: Undistorted.
        camera: Its camera.
        how: Preprocessing.
        others: The other models of the scene that are placed, with their poses (D,).
        last: (D,) pose in which the object was seen last.
        search: How widely to search.
    """
    near, far = depth_range(frame)
    is_coloured = frame.color is not None and how.use_skin
    hands = [Scene((other,)).pose_at(pose).landmarks(0) for other, pose in others if other.hand]
    for other, pose in others:
        if not (other.hand and is_coloured):
            frame = leave_out(frame, camera, Scene((other,)), pose, [0])
    frame = leave_out_forearms(frame, camera, hands)
    joints = np.concatenate([np.zeros((0, 3)), *hands])
    return find_object(frame, camera, model, how, near, far, joints, last, search)

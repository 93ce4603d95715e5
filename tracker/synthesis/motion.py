"""Simple, smooth motions for any hand model: open and close, wave, count, pinch."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.scene import Scene
from tracker.synthesis.actor import Actor
from tracker.synthesis.camera_ring import surround
from tracker.synthesis.performance import Performance
from tracker.synthesis.shading import SKIN

Array = npt.NDArray[np.float64]

DISTANCE = 0.5
"""From the camera to the knuckles, m."""

APART = 0.11
"""How far from the optical axis each of two hands is, m; the right hand is left in the image, as face to face."""

FPS = 30.0


def perform(
    models: dict[str, ArticulatedModel],
    motion: str,
    num_moments: int,
    num_cameras: int = 1,
    size: tuple[int, int] = (640, 480),
) -> Performance:
    """One or two hands, by side, that perform one of `MOTIONS` in front of a Carmine's camera at the world's origin.

    Args:
        models: Hands by side.
        motion: A name out of `MOTIONS`.
        num_moments: At `FPS`.
        num_cameras: The others stand around the hands and look at them.
        size: Width and height of the images, px; the view stays as wide as the Carmine's.
    """
    actors = []
    for side, model in models.items():
        x = 0.0 if len(models) == 1 else -APART if side == "right" else APART
        scene = Scene((model,))
        Ms = np.array([scene.pose_at(pose).Ms for pose in perform_motion(model, motion, num_moments, FPS, x)])
        actors.append(Actor(side, model, Ms, SKIN))
    width, height = size
    focal = 525.0 * width / 640
    K = np.array([[focal, 0.0, 0.5 * (width - 1)], [0.0, focal, 0.5 * (height - 1)], [0.0, 0.0, 1.0]])
    camera = Camera("cam0", width, height, K)
    others = surround(camera, np.array([0.0, 0.02, DISTANCE]), num_cameras - 1)
    return Performance(motion, FPS, camera, tuple(actors), others)


def perform_motion(model: ArticulatedModel, motion: str, num_moments: int, fps: float, x: float = 0.0) -> Array:
    """Poses (T, D) of a hand that performs one of `MOTIONS` in front of a camera at the world's origin.

    The fingers point up in the image and the palm faces the camera; the hand sways a little all the time.

    Args:
        model: A hand.
        motion: A name out of `MOTIONS`.
        num_moments: T.
        fps: Moments a second.
        x: Where the knuckle of the middle finger is placed, to the right of the optical axis, m.
    """
    assert model.hand is not None, "only hands perform"
    T_world_placed = _place(model, x)
    curls_at = MOTIONS[motion]
    full = find_closing(model)
    wrist = model.skeleton.joints_rest[0]
    poses = np.zeros((num_moments, model.num_dofs))
    for moment in range(num_moments):
        seconds = moment / fps
        for finger, curl in enumerate(curls_at(seconds)):
            poses[moment, 6:] += curl * full[finger]
        sway = _sway(seconds, swing=0.35 if motion == "wave" else 0.06)
        center = se3.transform(T_world_placed, wrist)
        sway[:3, 3] += center - sway[:3, :3] @ center
        poses[moment, :6] = se3.log(sway @ T_world_placed)
    return poses


def _open_close(seconds: float) -> Array:
    closed = 0.5 - 0.5 * np.cos(np.pi * seconds)
    return np.array([0.5, 0.8, 0.8, 0.8, 0.8]) * closed


def _wave(seconds: float) -> Array:
    return 0.12 + 0.06 * np.sin(2.0 * seconds + np.arange(5))


def _count(seconds: float) -> Array:
    """From a fist, the index finger first, the thumb last; then all close again."""
    order = np.array([4, 0, 1, 2, 3])
    stretched = np.clip(seconds % 4.0 / 0.5 - order, 0.0, 1.0)
    closing = np.clip(seconds % 4.0 / 0.5 - 7.0, 0.0, 1.0)
    smooth = 3 * stretched**2 - 2 * stretched**3
    return np.array([0.5, 0.8, 0.8, 0.8, 0.8]) * np.maximum(1.0 - smooth, 3 * closing**2 - 2 * closing**3)


def _pinch(seconds: float) -> Array:
    closed = 0.5 - 0.5 * np.cos(2.0 * np.pi * seconds / 1.5)
    return np.array([0.6, 0.5, 0.1, 0.1, 0.1]) * closed + np.array([0.0, 0.05, 0.1, 0.15, 0.2])


MOTIONS: dict[str, Callable[[float], Array]] = {
    "open-close": _open_close,
    "wave": _wave,
    "count": _count,
    "pinch": _pinch,
}
"""Name to a function of time, s, that says how far each finger, thumb first, is curled: (5,), 0 stretched, 1 closed."""


def _sway(seconds: float, swing: float) -> Array:
    """A slow motion (4, 4) of the whole hand; `swing` is how far it turns about the optical axis, rad."""
    turn = np.array([0.08 * np.sin(1.1 * seconds), 0.12 * np.sin(0.9 * seconds), swing * np.sin(3.0 * seconds)])
    move = np.array([0.012 * np.sin(0.8 * seconds), 0.008 * np.sin(1.3 * seconds), 0.015 * np.sin(0.7 * seconds)])
    T = se3.exp(np.r_[np.zeros(3), turn])
    T[:3, 3] = move
    return T


def find_closing(model: ArticulatedModel) -> Array:
    """Joint angles (5, K), rad, that close each finger, thumb first.

    Nothing is assumed about axes and signs: of the joints at one bone the one is taken, and in that direction, whose
    limit brings the fingertip closest to the wrist (for the thumb: to the knuckle of the little finger).
    """
    assert model.hand is not None
    scene = Scene((model,))
    skeleton = model.skeleton
    result = np.zeros((len(FINGERS), len(skeleton.dof_bones)))
    for number, finger in enumerate(FINGERS):
        joints = [j for j, name in enumerate(HAND_JOINTS) if name.startswith(finger)]
        target = HAND_JOINTS.index("little_mcp" if finger == "thumb" else "wrist")
        for bone in model.hand.joint_bones[joints[:-1]]:
            best = None
            for dof in np.flatnonzero(skeleton.dof_bones == bone):
                for limit in (skeleton.lower[dof], skeleton.upper[dof]):
                    pose = scene.rest_pose()
                    pose[6 + dof] = np.clip(limit, -1.0, 1.0)
                    moved = scene.pose_at(pose).landmarks(0)
                    distance = float(np.linalg.norm(moved[joints[-1]] - moved[target]))
                    if best is None or distance < best[0]:
                        best = (distance, dof, limit)
            if best is not None:
                result[number, best[1]] = np.clip(best[2], -1.6, 1.6)
    return result


def _place(model: ArticulatedModel, x: float) -> Array:
    """(4, 4) model to world: fingers up in the image, palm towards the camera, middle knuckle on the axis."""
    up, palm = np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, -1.0])
    return stand_hand(model, up, palm, np.array([x, 0.02, DISTANCE]))


def stand_hand(model: ArticulatedModel, towards: Array, faced: Array, at: Array) -> Array:
    """(4, 4) model to world of a hand at rest.

    Args:
        model: The hand.
        towards: (3,) unit, world; where the fingers point.
        faced: (3,) unit, world, across `towards`; where the palm looks.
        at: (3,) world, m; the middle knuckle's place.
    """
    scene = Scene((model,))
    rest = scene.pose_at(scene.rest_pose()).landmarks(0)
    pose = scene.rest_pose()
    pose[6:] = 0.4 * find_closing(model)[1:].sum(axis=0)
    closing = scene.pose_at(pose).landmarks(0)
    knuckle = rest[HAND_JOINTS.index("middle_mcp")]
    tips = [HAND_JOINTS.index(f"{finger}_tip") for finger in FINGERS[1:]]
    up = knuckle - rest[0]
    up /= np.linalg.norm(up)
    palm = (closing[tips] - rest[tips]).mean(axis=0)
    palm -= up * (palm @ up)
    palm /= np.linalg.norm(palm)
    model_axes = np.stack([up, palm, np.cross(up, palm)], axis=1)
    world_axes = np.stack([towards, faced, np.cross(towards, faced)], axis=1)
    T = np.eye(4)
    T[:3, :3] = world_axes @ model_axes.T
    T[:3, 3] = at - T[:3, :3] @ knuckle
    return T

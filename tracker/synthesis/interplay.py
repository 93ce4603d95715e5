"""Two hands that work together: fingers that cross and fold, a ball that is held and passed on, after [T16] §4.4.1."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter1d

from tracker.capture.camera import Camera
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.ball import make_ball
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.scene import Scene
from tracker.synthesis.actor import Actor
from tracker.synthesis.ball import RADIUS
from tracker.synthesis.camera_ring import surround
from tracker.synthesis.motion import stand_hand
from tracker.synthesis.performance import Performance
from tracker.synthesis.shading import OBJECT_COLORS, SKIN
from tracker.terms.collision import Collision

Array = npt.NDArray[np.float64]

FPS = 50.0
"""As the recordings of [T16] §4.4."""

CENTER = np.array([0.0, 0.0, 0.7])
"""What all cameras look at, world, m; the first stands at the origin."""

FLESH = 0.025
"""From the ball to the middle of the palm's bones, m."""

SIDES = {"right": -1.0, "left": 1.0}
"""Where each hand is along x, as seen by somebody who faces them."""

RETURN = 0.14
"""Share of the whole in which hands return to a third (1 / e) of the way to where they were planned. In every second
of the middle 64 of 144 moments of "crossing" bodies are at most 10.4, 1.5 and 0.4 mm deep in each other with 0, 0.07
and 0.14, and joints go at most 28, 33 and 14 mm from one to the next."""

PARTING = FitOptions(iterations=40, damping=0.3, max_turn=0.05, max_shift=0.002, fine=40)
SMOOTH = 0.01
"""Share of the whole over which what moves the hands apart is smoothed."""


def play(
    models: dict[str, ArticulatedModel],
    name: str,
    num_moments: int,
    num_cameras: int = 8,
    size: tuple[int, int] = (1920, 1080),
) -> Performance:
    """Both hands that perform one of `INTERPLAYS` once, in front of a ring of cameras.

    Planned poses in which flesh meets flesh are moved apart by the collision term, and what moves them is smoothed.

    Args:
        models: Hands by side, both.
        name: A name out of `INTERPLAYS`.
        num_moments: At `FPS`, for the whole of it.
        num_cameras: 1 to 8.
        size: Width and height of the images, px; the view stays as wide as the Carmine's.
    """
    balls = (make_ball(RADIUS),) if INTERPLAYS[name][1] else ()
    scene = Scene((models["right"], models["left"], *balls))
    poses = find_poses(scene, name, num_moments)
    Ms = np.array([scene.pose_at(pose).Ms for pose in poses])
    called = (("right", SKIN), ("left", SKIN), ("ball", OBJECT_COLORS[1]))
    actors = tuple(
        Actor(actor, model, Ms[:, bones], albedo)
        for (actor, albedo), model, bones in zip(called, scene.models, scene.bone_slices, strict=False)
    )
    width, height = size
    focal = 525.0 * width / 640
    K = np.array([[focal, 0.0, 0.5 * (width - 1)], [0.0, focal, 0.5 * (height - 1)], [0.0, 0.0, 1.0]])
    camera = Camera("cam0", width, height, K)
    return Performance(name, FPS, camera, actors, surround(camera, CENTER, num_cameras - 1))


def find_poses(scene: Scene, name: str, num_moments: int) -> Array:
    """Poses (T, D) of the scene, the right hand, the left one and the ball if there is one, of one of `INTERPLAYS`."""
    plan = INTERPLAYS[name][0]
    return _part(scene, np.array([plan(scene, moment / max(num_moments - 1, 1)) for moment in range(num_moments)]))


def _cross(scene: Scene, share: float) -> Array:
    """Hands come together, their fingers cross, fold over the other hand, stretch, and the hands part."""
    near = _ease(share / 0.35) * _ease((1.0 - share) / 0.3)
    folded = _ease((share - 0.35) / 0.15) * _ease((0.72 - share) / 0.15)
    tilt = 0.15 + 0.45 * near
    turn = se3.exp(np.array([0.0, 0.0, 0.0, 0.1 * np.sin(5.0 * share), 0.9 + 0.25 * np.sin(3.0 * share), 0.0]))[:3, :3]
    pose = scene.rest_pose()
    for (_, side), model, where in zip(SIDES.items(), scene.models, scene.pose_slices, strict=False):
        towards = np.array([-side * np.sin(tilt), -np.cos(tilt), 0.0])
        faced = np.array([-side * np.cos(tilt), np.sin(tilt), 0.0])
        at = np.array([side * (0.085 - 0.043 * near), 0.04, 0.006 * side])
        own = pose[where]
        own[6:] = curl_fingers(model, 0.05 + 0.27 * folded) + 0.8 * near * find_spreading(model)
        own[6:] += 0.04 * np.sin(6.0 * share + np.arange(len(own) - 6)) * (np.abs(own[6:]) > 0.02)
        own[:6] = se3.log(stand_hand(model, turn @ towards, turn @ faced, CENTER + turn @ at))
    return pose


def _pass(scene: Scene, share: float) -> Array:
    """One hand brings a ball, the other takes it and goes with it."""
    turn = se3.exp(np.array([0.0, 0.0, 0.0, 0.15 * np.sin(3.0 * share), 0.5, 0.0]))[:3, :3]
    ball = np.array(
        [0.07 * (_ease((share - 0.55) / 0.45) - _ease((0.45 - share) / 0.45)), 0.015 * np.sin(4.0 * share), 0.0]
    )
    pose = scene.rest_pose()
    for (_, side), model, where in zip(SIDES.items(), scene.models, scene.pose_slices, strict=False):
        away = _ease((share - 0.55) / 0.45) if side < 0 else _ease((0.45 - share) / 0.45)
        roll = 0.5 * side  # about x, so that fingers of both hands find room on the ball
        towards = np.array([0.0, -np.cos(roll), np.sin(roll)])
        faced = np.array([-side, 0.0, 0.0])
        palm = ball + np.array([side * (RADIUS + FLESH + 0.11 * away), 0.0, 0.0])
        own = pose[where]
        own[6:] = curl_fingers(model, 0.34 - 0.26 * away)
        own[:6] = se3.log(stand_hand(model, turn @ towards, turn @ faced, CENTER + turn @ (palm + 0.03 * towards)))
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = turn, CENTER + turn @ ball
    pose[scene.pose_slices[2]] = se3.log(T)
    return pose


INTERPLAYS: dict[str, tuple[Callable[[Scene, float], Array], bool]] = {
    "crossing": (_cross, False),
    "passing": (_pass, True),
}
"""Name to what plans the poses at a share of the whole, and whether there is a ball."""


def find_spreading(model: ArticulatedModel) -> Array:
    """(K,) joint angles, rad, that spread the fingers away from the middle one, at most by 0.6 rad each."""
    assert model.hand is not None
    scene, skeleton = Scene((model,)), model.skeleton
    middle = HAND_JOINTS.index("middle_tip")
    wide = np.zeros(len(skeleton.dof_bones))
    for finger in FINGERS[1:]:
        tip = HAND_JOINTS.index(f"{finger}_tip")
        if tip == middle:
            continue
        best = (0.0, 0, 0.0)
        for dof in np.flatnonzero(skeleton.dof_bones == model.hand.joint_bones[tip - 3]):
            for limit in np.clip([skeleton.lower[dof], skeleton.upper[dof]], -0.6, 0.6):
                gain = _measure_gap(scene, int(dof), limit, tip, middle) - _measure_gap(
                    scene, int(dof), 0.0, tip, middle
                )
                best = max(best, (gain, int(dof), float(limit)))
        wide[best[1]] = best[2]
    return wide


def _measure_gap(scene: Scene, dof: int, angle: float, tip: int, other: int) -> float:
    """Distance of two fingertips across the palm, m, with one joint at an angle."""
    pose = scene.rest_pose()
    pose[6 + dof] = angle
    joints = scene.pose_at(pose).landmarks(0)
    across = joints[HAND_JOINTS.index("index_mcp")] - joints[HAND_JOINTS.index("little_mcp")]
    return float(abs((joints[tip] - joints[other]) @ across) / np.linalg.norm(across))


def _part(scene: Scene, planned: Array) -> Array:
    """Poses (T, D) near the planned ones in which next to nothing intersects; an object stays where it was planned.

    Each moment begins with most of what moved the one before, so that a finger passes another on one side all along:
    smoothing a motion that changes sides would push them into each other again.
    """
    objective = Objective(terms={"collision": Collision(weight=1.0)})
    moved, kept = np.zeros_like(planned), float(np.exp(-1.0 / (RETURN * len(planned))))
    for moment, pose in enumerate(planned):
        start = pose if moment == 0 else _move(scene, pose, kept * moved[moment - 1])
        found = fit_frame(scene, None, start, start, objective, PARTING).pose
        for model, where in zip(scene.models, scene.pose_slices, strict=True):
            if model.hand is not None:
                root = slice(where.start, where.start + 6)
                moved[moment, where] = found[where] - pose[where]
                moved[moment, root] = se3.log(se3.exp(found[root]) @ se3.inverse(se3.exp(pose[root])))
    smooth: Array = gaussian_filter1d(moved, SMOOTH * len(moved), axis=0, mode="nearest")
    return np.array([_move(scene, pose, smooth[moment]) for moment, pose in enumerate(planned)])


def _move(scene: Scene, pose: Array, by: Array) -> Array:
    """A pose (D,) with angles added and roots moved by twists in the world, both (D,)."""
    result = pose + by
    for where in scene.pose_slices:
        root = slice(where.start, where.start + 6)
        result[root] = se3.log(se3.exp(by[root]) @ se3.exp(pose[root]))
    return result


def _ease(share: float) -> float:
    """0 below 0, 1 above 1, smooth between."""
    x = float(np.clip(share, 0.0, 1.0))
    return x * x * (3.0 - 2.0 * x)

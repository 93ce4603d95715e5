"""Fit a hand to the few joints that somebody has marked so far, and say where its other joints would be."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.errors import TrackingError, say_count
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.region import region_around, region_around_joints
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import PosedScene, Scene
from tracker.observation import Observation, Preprocessing, observe, undistort
from tracker.rendering import render_view
from tracker.search.start_annotated import start_hand, undistort_points, with_marks
from tracker.tracking.track import Track

Array = npt.NDArray[np.float64]

MIN_FIT_JOINTS = 4
"""With fewer marked joints a hand may be anywhere."""

REACH = 0.16
"""A hand is looked for this far around its marked joints, m."""

THICKNESS = 0.022
"""A joint this far behind the nearest surface is still its own finger's, m."""

DESCENT, ITERATIONS = 14, 6
"""Steps to the marks alone, and then to the depth image too: what an annotator waits for after every click."""


@dataclass(frozen=True)
class QuickFit:
    """Where a model would have the joints of a hand.

    Attributes:
        joints: (21, 2) px of the recorded image; NaN behind the camera.
        is_hidden: (21,) whether something of the model lies in front of the joint.
        uses_depth: Whether a depth image was used.
    """

    joints: Array
    is_hidden: npt.NDArray[np.bool_]
    uses_depth: bool


def fit_marked(model: ArticulatedModel, points: Array, camera: Camera, frame: Frame | None = None) -> QuickFit:
    """Fit a hand to its marked joints, within its joint limits ([T16] Eq. 17), and to the depth where there is any.

    Args:
        model: The hand.
        points: (21, 3) x, y px of the recorded image and v (0: not marked yet).
        camera: The recorded one.
        frame: As recorded, with depth; None: from the marks alone, at the distance that follows from the hand's size.

    Raises:
        TrackingError: Too few joints.
    """
    assert points.shape == (21, 3)
    marked = int(np.count_nonzero(points[:, 2]))
    if marked < MIN_FIT_JOINTS:
        raise TrackingError(
            f"{say_count(marked, 'joint is', 'joints are')} marked; "
            f"a model is fitted to {MIN_FIT_JOINTS} or more. Mark some more."
        )
    marks = undistort_points(points, camera)
    ideal = replace(camera, distortion=np.zeros(0))
    seen = None
    if frame is not None and frame.depth is not None:
        frame, ideal = undistort(frame, camera)
        seen = _look(frame, ideal, marks)
    pose = start_hand(model, marks, ideal, seen, DESCENT)
    scene = Scene((model,))
    if frame is not None and seen is not None:
        pose = _settle(scene, frame, ideal, marks, pose)
    posed = scene.pose_at(pose)
    joints = camera.project(posed.landmarks(0))
    return QuickFit(joints, find_hidden(posed, posed.landmarks(0), ideal), seen is not None)


def view_track_hands(track: Track, row: int, camera: Camera) -> dict[str, QuickFit]:
    """Where a track has the joints of each hand, in one of its rows, as any camera of the recording sees them."""
    scene = track.setup.scene
    posed = scene.pose_at(track.pose[row])
    found = {}
    for place, (name, model) in enumerate(zip(track.setup.names, scene.models, strict=True)):
        if model.hand:
            points = posed.landmarks(place)
            found[name] = QuickFit(camera.project(points), find_hidden(posed, points, camera), True)
    return found


def find_hidden(posed: PosedScene, points: Array, camera: Camera) -> npt.NDArray[np.bool_]:
    """Which of some points (N, 3) world, m, in or on a posed scene lie behind another surface of it.

    Args:
        posed: The scene.
        points: Such as joints.
        camera: Its distortion is left out of account.
    """
    drawn = render_view(posed, camera.K, camera.T_world_camera, camera.height, camera.width).depth
    in_camera = se3.transform(camera.T_camera_world, points)
    depths = in_camera[:, 2]
    pixels = in_camera[:, :2] / np.maximum(depths, 1e-6)[:, None] * camera.K[[0, 1], [0, 1]] + camera.K[:2, 2]
    columns = np.clip(np.round(pixels[:, 0]), 0, camera.width - 1).astype(int)
    rows = np.clip(np.round(pixels[:, 1]), 0, camera.height - 1).astype(int)
    nearest = drawn[rows, columns]
    return (nearest > 0) & (depths - nearest > THICKNESS)


def _look(frame: Frame, camera: Camera, marks: Array) -> Observation | None:
    """The depth around the marked joints; None where there is none at any of them."""
    assert frame.depth is not None
    known, visible = marks[marks[:, 2] > 0, :2], marks[marks[:, 2] == 2, :2]
    region = region_around_joints(known, visible, frame.depth, camera, REACH, REACH)
    return None if region is None else observe(frame, camera, region, Preprocessing())


def _settle(scene: Scene, frame: Frame, camera: Camera, marks: Array, pose: Array) -> Array:
    """The pose after some iterations of the tracker's own objective, with the marked joints kept where they are."""
    region = region_around(scene.pose_at(pose).vertices, camera)
    if region is None:
        return pose
    seen = observe(frame, camera, region, Preprocessing())
    objective = with_marks(Objective(), scene, ("hand",), {"hand": marks}, camera)
    options = FitOptions(iterations=ITERATIONS, damping=1e-2, fine=0)
    return fit_frame(scene, seen, pose, pose, objective, options).pose

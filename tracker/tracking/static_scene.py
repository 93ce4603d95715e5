"""The static scene of a run: as the recording names it, or as the depth image of the first frame shows it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.sequence import Sequence
from tracker.capture.static_plane import StaticPlane
from tracker.fitting.setup import TrackSetup
from tracker.physics import StaticScene, choose_down, find_plane

Array = npt.NDArray[np.float64]

STRIDE = 6
"""Step in px of the pixels of the depth image that are examined."""

FARTHEST = 3.0
"""m; beyond it depth cameras are too noisy."""

AROUND = 0.05
"""Points this near to the box around hands and objects are left out: a palm is flat too, m."""

MIN_SHARE = 0.15
"""Of the image that a plane must cover: more than a forearm or a book does."""

MAX_BEHIND = 0.02
"""A plane that hands or objects reach behind by more is none that they stand before, m."""


def see_static_scene(sequence: Sequence, setup: TrackSetup, frame: Frame, camera: Camera, pose: Array) -> StaticScene:
    """Planes and gravity for a run, as its option `static_scene` wants them.

    Args:
        sequence: Its own planes and gravity count before what is found.
        setup: Models and options.
        frame: The first of the run.
        camera: It was seen by.
        pose: (D,) of hands and objects in it.
    """
    wanted, planes, planes_from = setup.options.static_scene, sequence.planes, "recording"
    if wanted == "none" or (wanted == "recording" and not planes):
        planes, planes_from = (), "nobody"
    elif not planes:
        found = find_plane_behind(setup, frame, camera, pose)
        planes, planes_from = ((found,), "depth") if found else ((), "nobody")
    down, down_from = choose_down(sequence.gravity, planes, camera.T_world_camera)
    return StaticScene(down, down_from, planes, planes_from)


def find_plane_behind(setup: TrackSetup, frame: Frame, camera: Camera, pose: Array) -> StaticPlane | None:
    """The largest plane in the depth image that all hands and objects stand before; None where there is none."""
    assert frame.depth is not None
    depth = frame.depth[::STRIDE, ::STRIDE].astype(np.float64)
    rows, columns = np.nonzero((depth > 0.0) & (depth < FARTHEST))
    z = depth[rows, columns]
    points = camera.lift(STRIDE * np.stack([columns, rows], axis=1), z)
    vertices = setup.scene.pose_at(pose).vertices
    low, high = vertices.min(axis=0) - AROUND, vertices.max(axis=0) + AROUND
    outside = points[np.any((points < low) | (points > high), axis=1)]
    found = find_plane(outside, camera.T_world_camera[:3, 3], round(MIN_SHARE * depth.size))
    if found is None or np.min((vertices - np.array(found.point)) @ np.array(found.normal)) < -MAX_BEHIND:
        return None
    return found

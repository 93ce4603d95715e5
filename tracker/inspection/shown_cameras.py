"""Where the cameras stand, and along which rays they saw the joints of the hands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.fitting.view_hands import ViewHands
from tracker.geometry import se3
from tracker.landmarks import DetectedHand

Array = npt.NDArray[np.float64]

LENGTH = 0.1
"""Of a camera's pyramid, as a share of its distance from the hands: seen, and in nothing's way."""


@dataclass(frozen=True)
class ShownCamera:
    """One camera.

    Attributes:
        name: Its id.
        outline: (8, 2, 3) float32 edges of its pyramid, world, m.
        rays: (N, 2, 3) float32 from the camera to the place on each joint's ray that is nearest to the fitted joint.
        joints: (N,) which of the 21 joints each ray is of.
    """

    name: str
    outline: npt.NDArray[np.float32]
    rays: npt.NDArray[np.float32]
    joints: npt.NDArray[np.int64]


def show_cameras(
    cameras: Sequence[Camera], hands: Mapping[str, Array], seen: ViewHands | None
) -> tuple[ShownCamera, ...]:
    """The cameras of a recording, with the rays of what was seen in them.

    Args:
        cameras: All of the recording.
        hands: By name, (21, 3) fitted joints, world, m.
        seen: What the detector saw in the views that are tracked in; None where one depth camera is.
    """
    middle = np.mean(np.concatenate([*hands.values(), np.zeros((0, 3))]), axis=0) if hands else np.zeros(3)
    return tuple(_show(camera, middle, hands, seen.of_camera(camera.id) if seen else {}) for camera in cameras)


def _show(camera: Camera, middle: Array, hands: Mapping[str, Array], seen: Mapping[str, DetectedHand]) -> ShownCamera:
    origin = camera.T_world_camera[:3, 3]
    right, bottom = camera.width - 0.5, camera.height - 0.5  # the image's rim: pixel centres are integers
    corners = np.array([[-0.5, -0.5], [right, -0.5], [right, bottom], [-0.5, bottom]])
    ends = se3.transform(camera.T_world_camera, LENGTH * np.linalg.norm(middle - origin) * camera.unproject(corners))
    outline = [*((origin, end) for end in ends), *zip(ends, np.roll(ends, -1, axis=0), strict=True)]
    rays, joints = [np.zeros((0, 2, 3))], [np.zeros(0, dtype=np.int64)]
    for name, hand in seen.items():
        if name not in hands:
            continue
        directions = camera.unproject(hand.points) @ camera.T_world_camera[:3, :3].T
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        along = np.einsum("ji,ji->j", hands[name] - origin, directions)
        there = origin + along[:, None] * directions
        known = np.flatnonzero(np.isfinite(there).all(axis=1) & (along > 0.0))
        rays.append(np.stack([np.broadcast_to(origin, (len(known), 3)), there[known]], axis=1))
        joints.append(known)
    return ShownCamera(
        camera.id,
        np.array(outline, dtype=np.float32),
        np.concatenate(rays).astype(np.float32),
        np.concatenate(joints),
    )

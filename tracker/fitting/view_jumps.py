"""Joints detected farther from where they are expected than a hand can move, with nothing to confirm them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.landmarks import DetectedHand
from tracker.model.joints import HAND_JOINTS

Array = npt.NDArray[np.float64]

FASTEST = 1.0
"""m/s; a joint that is detected nearer to where it is expected did not jump. With 0.75, 1, 1.25, 1.5 and no limit
`two_camera_rgb` is followed in 371, 375, 369, 374 and 373 of 378 frames, 5.2, 4.6, 4.4, 5.0 and 5.0 px from its marks
in `cam0`. At 4.5 frames a second 1 m/s is 222 mm, so hardly anything is called a jump: with 30 mm `d405_take001` is
followed in 69 frames, in 102 without a limit."""

USUAL = 4.0
"""A joint did not jump either if it is detected less than this many times as far off as half of its hand's joints."""

MEETS = 0.008
"""m; two rays that pass so near to each other tell one joint."""

ALIKE = 0.6
"""Share of its way by which a joint's neighbour in the finger may have gone elsewhere."""

NEIGHBOURS = tuple(
    tuple(other for other in (joint - 1, joint + 1) if min(joint, other) > 0 and (other - 1) // 4 == (joint - 1) // 4)
    for joint in range(len(HAND_JOINTS))
)
"""Of each joint those beside it in its finger; the wrist has none."""


def find_jumps(
    joints: Array, cameras: Sequence[Camera], hands: Sequence[DetectedHand | None], fps: float
) -> npt.NDArray[np.bool_]:
    """(C, 21) which joints are detected far from where they are expected, with nothing to confirm them.

    A finger that moves fast takes its joints along: where a joint beside it in the finger went about the same way in
    the same view, or a second view tells the joint far off too and both rays meet, it moved.

    Args:
        joints: (21, 3) of the hand, where they are expected, world, m.
        cameras: C.
        hands: C, as each view sees the hand; None where it does not.
        fps: Frames a second.
    """
    rays = np.full((len(cameras), len(HAND_JOINTS), 3), np.nan)
    moved = np.full((len(cameras), len(HAND_JOINTS), 2), np.nan)
    for view, (camera, hand) in enumerate(zip(cameras, hands, strict=True)):
        if hand is not None:
            own = camera.unproject(hand.points) @ camera.T_world_camera[:3, :3].T
            rays[view] = own / np.linalg.norm(own, axis=1, keepdims=True)
            moved[view] = hand.points - camera.project(joints)
    origins = np.array([camera.T_world_camera[:3, 3] for camera in cameras]).reshape(-1, 3)
    away = np.linalg.norm(np.cross(joints - origins[:, None], rays), axis=2)
    is_told = np.isfinite(away)
    if not is_told.any():
        return is_told
    is_far = is_told & (away > max(FASTEST / fps, USUAL * float(np.median(away[is_told]))))
    jumps = is_far.copy()
    for view, joint in zip(*np.nonzero(is_far), strict=True):
        way = moved[view, joint]
        beside = moved[view, list(NEIGHBOURS[joint])] - way
        has_company = bool(np.any(np.linalg.norm(beside, axis=1) < ALIKE * np.linalg.norm(way)))
        meets = _measure_gaps(origins, rays[:, joint], view) < MEETS
        jumps[view, joint] = not (has_company or np.any(meets & is_far[:, joint]))
    return jumps


def _measure_gaps(origins: Array, rays: Array, view: int) -> Array:
    """(C,) how near each ray passes to that of one view, m; infinite of itself and where there is none."""
    across = np.cross(rays[view], rays)
    length = np.linalg.norm(across, axis=1)
    is_known = length > 1e-6
    gaps = np.abs(np.einsum("ci,ci->c", across, origins - origins[view])) / np.where(is_known, length, 1.0)
    return np.where(is_known & np.isfinite(gaps), gaps, np.inf)

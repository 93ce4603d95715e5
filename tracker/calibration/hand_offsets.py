"""Videos out of step, recognised without a board: by the motion of hands that a detector saw in calibrated views.

A joint lies on the epipolar line of where another camera sees it at the same moment, and while it moves at no other
moment (Hartley and Zisserman, Multiple View Geometry, 9.1). So every shift within reach is tried, and the one where
joints lie nearest to their lines is taken, as `camera_pair` does with a board's poses.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.calibration.camera_pair import TELLING
from tracker.capture.annotations import Annotations
from tracker.capture.camera import Camera
from tracker.errors import CalibrationError

Array = npt.NDArray[np.float64]

PARTS = 6
"""Of the recording, each of which tells its own shift: how far they scatter is how sure the shift of all is."""

MOST_SCATTER = 1.0
"""Frames, standard deviation of the parts' shifts about that of all, beyond which no shift is reported."""

MIN_SHARED = 30
"""Frames with a hand in both cameras at a shift, or it is not tried: a second of video."""


@dataclass(frozen=True)
class HandOffset:
    """How far a camera's video is out of step with the first camera's.

    Attributes:
        camera: Its id.
        frames: How many frames later a moment is in it.
        std_frames: Standard deviation of that, by how parts of the recording scatter.
        seconds: The same in seconds.
        is_known: The motion tells it: the best shift stands out, and parts of the recording agree on it.
        best_px: From joints to their lines at the best whole shift, median.
        now_px: As the recording is.
        usual_px: At the shifts within reach, median.
    """

    camera: str
    frames: float
    std_frames: float
    seconds: float
    is_known: bool
    best_px: float
    now_px: float
    usual_px: float

    def to_json(self) -> dict[str, Any]:
        return {name: round(v, 4) if isinstance(v, float) else v for name, v in vars(self).items()}

    def say(self, first: str) -> str:
        """A sentence."""
        px = f"{self.now_px:.1f} px from epipolar lines now, {self.best_px:.1f} at best, {self.usual_px:.1f} usually"
        if not self.is_known:
            return f"{self.camera}: the hands' motion does not tell whether it is in step with {first} ({px})."
        late = f"{self.frames:+.2f} ± {self.std_frames:.2f} frames ({1000 * self.seconds:+.1f} ms)"
        if not round(self.frames):
            return f"{self.camera}: is in step with {first}, {late} ({px})."
        whole = f"{self.camera}={round(self.frames):+d}"
        return f"{self.camera}: is out of step, a moment is {late} later in it than in {first}: {whole} ({px})."


def find_hand_offsets(cameras: Sequence[Camera], hands: Annotations, fps: float, reach: int) -> tuple[HandOffset, ...]:
    """The offset of each camera but the first.

    Args:
        cameras: Calibrated.
        hands: What the detector saw, or people marked, in consecutive frames.
        fps: Frames per second of all.
        reach: Frames, the farthest shift tried.

    Raises:
        CalibrationError: No two cameras see a hand in enough frames.
    """
    directions = [_find_directions(camera, hands) for camera in cameras]
    found = []
    for camera, seen in zip(cameras[1:], directions[1:], strict=True):
        planes = _find_planes(cameras[0], camera, directions[0])
        shifts = np.arange(-reach, reach + 1)
        off = [_measure(planes, seen, shift, float(camera.K[0, 0])) for shift in shifts.tolist()]
        medians = np.array([np.median(of[1]) if len(np.unique(of[0])) >= MIN_SHARED else np.nan for of in off])
        if not np.isfinite(medians[reach]):
            raise CalibrationError(
                f"{cameras[0].id} and {camera.id} see a hand in {len(np.unique(off[reach][0]))} common frames; needed "
                f"{MIN_SHARED}. Detect the hands of all frames first, in both cameras."
            )
        best = int(np.nanargmin(medians))
        exact = shifts[best] + _refine(medians, best)
        parts = _find_parts(off, shifts)
        scatter = float(np.sqrt(np.mean((parts - exact) ** 2))) if len(parts) > 2 else float("inf")
        usual = float(np.nanmedian(medians))
        is_known = usual >= TELLING * medians[best] and scatter <= MOST_SCATTER and 0 < best < 2 * reach
        std = scatter / np.sqrt(max(len(parts), 1))
        numbers = (float(exact), float(std), float(exact) / fps)
        found.append(
            HandOffset(camera.id, *numbers, bool(is_known), float(medians[best]), float(medians[reach]), usual)
        )
    return tuple(found)


def _find_directions(camera: Camera, hands: Annotations) -> dict[tuple[str, int], Array]:
    """By hand and frame, unit rays (21, 3), world, of its joints; NaN of those that are not seen."""
    own = [item for item in hands.items if item.camera == camera.id]
    marks = np.array([np.where(item.points[:, 2:] > 0, item.points[:, :2], np.nan) for item in own]).reshape(-1, 2)
    rays = camera.unproject(marks) @ camera.T_world_camera[:3, :3].T
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    return {(item.hand, item.frame): ray for item, ray in zip(own, rays.reshape(-1, 21, 3), strict=True)}


def _find_planes(
    first: Camera, camera: Camera, directions: dict[tuple[str, int], Array]
) -> dict[tuple[str, int], Array]:
    """Unit normals (21, 3), world, of the planes through both cameras and where the first one sees each joint."""
    baseline = camera.T_world_camera[:3, 3] - first.T_world_camera[:3, 3]
    planes = {key: np.cross(baseline, rays) for key, rays in directions.items()}
    return {key: normals / np.linalg.norm(normals, axis=1, keepdims=True) for key, normals in planes.items()}


def _measure(
    planes: dict[tuple[str, int], Array], seen: dict[tuple[str, int], Array], shift: int, focal: float
) -> tuple[npt.NDArray[np.int64], Array]:
    """Frames (n,) of the first camera and how far (n,), px, joints lie from their lines when shifted by so much."""
    keys = [key for key in planes if (key[0], key[1] + shift) in seen]
    if not keys:
        return np.zeros(0, dtype=np.int64), np.zeros(0)
    normals = np.array([planes[key] for key in keys])
    rays = np.array([seen[hand, frame + shift] for hand, frame in keys])
    distance = focal * np.abs(np.einsum("nji,nji->nj", normals, rays))
    is_known = np.isfinite(distance)
    frames = np.repeat(np.array([frame for _, frame in keys], dtype=np.int64)[:, None], 21, axis=1)
    return frames[is_known], distance[is_known]


def _find_parts(off: list[tuple[npt.NDArray[np.int64], Array]], shifts: npt.NDArray[np.int64]) -> Array:
    """The best shift of each part of the recording that has enough frames."""
    last = max((int(frames.max()) for frames, _ in off if len(frames)), default=0)
    borders = np.linspace(0, last + 1, PARTS + 1)
    found = []
    for low, high in pairwise(borders.tolist()):
        own = [distance[(frames >= low) & (frames < high)] for frames, distance in off]
        medians = np.array([np.median(some) if len(some) >= 21 * MIN_SHARED / PARTS else np.nan for some in own])
        if np.isfinite(medians).sum() > 2:
            best = int(np.nanargmin(medians))
            found.append(shifts[best] + _refine(medians, best))
    return np.array(found, dtype=np.float64)


def _refine(values: Array, best: int) -> float:
    """Where between its neighbours the minimum lies: two lines of one slope, as distances from lines grow linearly."""
    if not 0 < best < len(values) - 1 or not np.isfinite(values[best - 1 : best + 2]).all():
        return 0.0
    left, here, right = values[best - 1 : best + 2]
    slope = max(left, right) - here
    return float(0.5 * (left - right) / slope) if slope > 0 else 0.0

"""Hands whose joints somebody marked in cameras whose places are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotation, Annotations, save_annotations
from tracker.capture.camera import Camera
from tracker.capture.frame_pattern import parse_pattern
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence as Recording
from tracker.capture.sequence import save_sequence_json
from tracker.geometry.se3 import exp

Array = npt.NDArray[np.float64]

PLACE = np.array([0.0, 0.0, 1.0])
"""About which hands move, m; every camera looks at it."""

ANNOTATORS_DIFFER_PX = 1.5
"""[T16] section 4.2."""


def stand_around(count: int, apart_deg: float = 30.0) -> list[Camera]:
    """Cameras 1 m from the place, so far apart from each other."""
    cameras = []
    for number in range(count):
        angle = np.radians(apart_deg * (number - (count - 1) / 2))
        centre = np.array([np.sin(angle), -0.2, 1.0 - np.cos(angle)])
        z = (PLACE - centre) / np.linalg.norm(PLACE - centre)
        x = np.cross([0.0, 1.0, 0.0], z)
        T = np.eye(4)
        T[:3, 0] = x / np.linalg.norm(x)
        T[:3, 1], T[:3, 2], T[:3, 3] = np.cross(z, T[:3, 0]), z, centre
        K = np.array([[600.0, 0.0, 319.5], [0.0, 600.0, 239.5], [0.0, 0.0, 1.0]])
        cameras.append(Camera(f"cam{number}", 640, 480, K, T_world_camera=T))
    return cameras


def mark_hands(
    cameras: Sequence[Camera],
    frames: int,
    rng: np.random.Generator,
    spread_m: float = 0.2,
    noise_px: float = ANNOTATORS_DIFFER_PX,
) -> Annotations:
    """Labels of a hand that is elsewhere in every frame, at most so far from the place along each axis."""
    items = []
    for frame in range(frames):
        joints = PLACE + spread_m * rng.uniform(-1, 1, 3) + 0.05 * rng.normal(size=(21, 3))
        for camera in cameras:
            pixels = camera.project(joints) + noise_px * rng.normal(size=(21, 2))
            items.append(Annotation(frame, camera.id, "right", np.column_stack([pixels, np.full(21, 2.0)])))
    return Annotations(tuple(items))


def knock(cameras: Sequence[Camera], rng: np.random.Generator, mm: float = 15.0, deg: float = 1.0) -> list[Camera]:
    """All cameras but the first moved and turned by so much, each in a direction of its own."""
    knocked = [cameras[0]]
    for camera in cameras[1:]:
        move, turn = rng.normal(size=(2, 3))
        T = camera.T_world_camera.copy()
        T[:3, 3] += mm / 1000 * move / np.linalg.norm(move)
        T[:3, :3] = (
            T[:3, :3] @ exp(np.concatenate([np.zeros(3), np.radians(deg) * turn / np.linalg.norm(turn)]))[:3, :3]
        )
        knocked.append(replace(camera, T_world_camera=T))
    return knocked


def find_farthest_off_px(found: Sequence[Camera], truth: Sequence[Camera], reach_m: float = 0.2) -> float:
    """How far apart two sets of cameras see points about the place at worst, once both have the same baseline."""
    grid = np.stack(np.meshgrid(*[np.linspace(-reach_m, reach_m, 3)] * 3), axis=-1).reshape(-1, 3) + PLACE
    baselines = [
        np.linalg.norm(some[-1].T_world_camera[:3, 3] - some[0].T_world_camera[:3, 3]) for some in (found, truth)
    ]
    origin = truth[0].T_world_camera[:3, 3]
    scaled = origin + baselines[0] / baselines[1] * (grid - origin)
    pairs = zip(found, truth, strict=True)
    return max(float(np.linalg.norm(own.project(scaled) - true.project(grid), axis=1).max()) for own, true in pairs)


def record_knocked(folder: Path, rng: np.random.Generator, frames: int = 40) -> None:
    """Write a recording of four cameras, all but the first knocked after they were calibrated, and labels."""
    truth = stand_around(4)
    labels = mark_hands(truth, frames, rng)
    cameras = tuple(
        RecordedCamera(
            c.id, c.width, c.height, c.K, c.distortion, c.T_world_camera, parse_pattern(f"{c.id}/{{:06d}}.jpg")
        )
        for c in knock(truth, rng)
    )
    for item in labels.items:
        picture = np.full((480, 640, 3), 40, np.uint8)
        for x, y in item.points[:, :2].round().astype(int).tolist():
            cv2.circle(picture, (x, y), 4, (150, 170, 210), -1)
        path = folder / item.camera / f"{item.frame:06d}.jpg"
        path.parent.mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(path), picture)
    save_sequence_json(Recording(folder, "knocked", 30.0, frames, cameras, annotations="annotations.json"))
    save_annotations(folder / "annotations.json", labels)

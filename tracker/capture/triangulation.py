"""Where a point is that several calibrated cameras see, and how well their marks agree about it.

Direct linear transformation (Hartley and Zisserman, Multiple View Geometry, 12.2), then Gauss-Newton on the distance in
the images; all projection is `Camera.project`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

MIN_ANGLE_DEG = 1.0
"""Rays that differ by less tell no depth: a mark that is 1 px off (f = 525 px) moves the point by a tenth of its
distance."""

OUTLIER_PX = 5.0
"""A mark is called into question when the views disagree by more; annotators differ by 1.5 px [T16] §4.2."""

GAUSS_NEWTON_STEPS = 2
"""That follow the linear solution."""


@dataclass(frozen=True, eq=False)
class Triangulation:
    """N points as C cameras see them. What is not known is NaN.

    Attributes:
        points: (N, 3) world, m.
        is_used: (N, C) views whose marks made the point.
        residuals: (N, C) distance of each mark to where its camera sees the point, px.
        left_out_residuals: (N, C) distance of each mark to the point that the other views alone make, px.
        angles_deg: (N,) the largest angle between two rays; lines, so at most 90.
        std_m: (N,) standard deviation of the point along its worst direction, m, if marks are off by 1 px in x and y.
        refusals: (N,) why there is no point; empty when there is one.
    """

    points: Array
    is_used: Mask
    residuals: Array
    left_out_residuals: Array
    angles_deg: Array
    std_m: Array
    refusals: tuple[str, ...]


def triangulate(cameras: Sequence[Camera], marks: Array) -> Triangulation:
    """Triangulate N points.

    When three views or more disagree, and all but one agree, that one is set aside: it is not used, and its residual
    says how far it is off.

    Args:
        cameras: C of them.
        marks: (N, C, 2) px; NaN where a camera has no mark of the point.
    """
    N, C = len(marks), len(cameras)
    assert marks.shape == (N, C, 2)
    rays = np.full((N, C, 3), np.nan)
    for c, camera in enumerate(cameras):
        rays[:, c] = camera.unproject(np.ascontiguousarray(marks[:, c]))
    has_ray = np.asarray(np.isfinite(rays).all(axis=2))
    # Every point from all its views (k = 0), and from all but camera k - 1.
    masks = np.repeat(has_ray[:, None], C + 1, axis=1)
    masks[:, np.arange(1, C + 1), np.arange(C)] = False
    is_tried = masks.sum(axis=2) >= 2
    is_tried[:, 1:] &= has_ray
    points = np.full((N, C + 1, 3), np.nan)
    points[is_tried] = _solve(cameras, marks, rays, masks, is_tried)
    distances = np.full((N, C + 1, C), np.nan)
    for c, camera in enumerate(cameras):
        pixels = camera.project(points.reshape(-1, 3)).reshape(N, C + 1, 2)
        distances[:, :, c] = np.linalg.norm(pixels - marks[:, None, c], axis=2)
    chosen = np.array([_choose(distances[n], masks[n]) for n in range(N)], dtype=np.int64)
    everyone = np.arange(N)
    is_used = masks[everyone, chosen]
    angles = _find_angles(cameras, rays, is_used)
    num_marks = np.asarray(np.isfinite(marks).all(axis=2)).sum(axis=1)
    refusals = tuple(
        _refuse(num_marks[n], has_ray[n], angles[n], distances[n, chosen[n]][is_used[n]]) for n in everyone
    )
    found = points[everyone, chosen]
    residuals = distances[everyone, chosen]
    left_out = distances[:, 1 + np.arange(C), np.arange(C)]
    is_refused = np.array([bool(refusal) for refusal in refusals], dtype=bool)
    for values in (found, residuals, left_out):
        values[is_refused] = np.nan
    is_used[is_refused] = False
    std = _find_std(cameras, found, is_used)
    return Triangulation(found, is_used, residuals, left_out, angles, std, refusals)


def _solve(cameras: Sequence[Camera], marks: Array, rays: Array, masks: Mask, is_tried: Mask) -> Array:
    """Points (P, 3) world, of the P pairs (point, subset of views) that are tried."""
    numbers, subsets = np.nonzero(is_tried)
    weights = masks[numbers, subsets].astype(np.float64)  # (P, C)
    # Metres about the cameras' centre keep the equations well scaled.
    origin = np.mean([camera.T_world_camera[:3, 3] for camera in cameras], axis=0)
    AtA = np.zeros((len(numbers), 4, 4))
    for c, camera in enumerate(cameras):
        T = camera.T_camera_world.copy()
        T[:3, 3] += T[:3, :3] @ origin
        ray = np.nan_to_num(rays[numbers, c])
        rows = ray[:, :2, None] * T[2] - T[:2]  # (P, 2, 4)
        AtA += np.einsum("p,pri,prj->pij", weights[:, c], rows, rows)
    X = np.linalg.eigh(AtA)[1][:, :, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        points = X[:, :3] / X[:, 3:] + origin
    points[~(np.abs(points) < 1e4).all(axis=1)] = np.nan
    for _ in range(GAUSS_NEWTON_STEPS):
        H, g = np.zeros((len(points), 3, 3)), np.zeros((len(points), 3))
        for c, camera in enumerate(cameras):
            here, J = _linearize(camera, points)
            e = here - marks[numbers, c]
            w = np.where(np.isfinite(e).all(axis=1) & np.isfinite(J).all(axis=(1, 2)), weights[:, c], 0.0)
            e, J = np.nan_to_num(e), np.nan_to_num(J)
            H += np.einsum("p,pri,prj->pij", w, J, J)
            g += np.einsum("p,pri,pr->pi", w, J, e)
        # A touch of damping, for points that the views hardly hold: those are refused afterwards.
        H += 1e-9 * np.trace(H, axis1=1, axis2=2)[:, None, None] * np.eye(3) + 1e-12 * np.eye(3)
        step = np.linalg.solve(H, g[:, :, None])[:, :, 0]
        points = points - step
    return points


def _linearize(camera: Camera, points: Array) -> tuple[Array, Array]:
    """Pixels (P, 2) and their derivatives (P, 2, 3), px/m, by central differences on the one way to project."""
    h = 1e-5
    offsets = np.concatenate([np.zeros((1, 3)), h * np.eye(3), -h * np.eye(3)])
    pixels = camera.project((points + offsets[:, None]).reshape(-1, 3)).reshape(7, len(points), 2)
    return pixels[0], np.moveaxis((pixels[1:4] - pixels[4:]) / (2 * h), 0, 2)


def _choose(distances: Array, masks: Mask) -> int:
    """Which row of `distances` (C + 1, C) to believe: 0 for all views, k when camera k - 1 is to be set aside.

    One view is set aside only if the others agree without it, and would not agree as well without another one instead.
    """
    spread = np.max(np.where(masks, distances, -np.inf), axis=1)
    candidates = [k for k in range(1, len(distances)) if np.isfinite(spread[k]) and np.isfinite(distances[k, k - 1])]
    if spread[0] <= OUTLIER_PX or len(candidates) < 3:
        return 0
    best, second = sorted(candidates, key=lambda k: float(spread[k]))[:2]
    is_clear = spread[best] < 0.5 * OUTLIER_PX and spread[second] > 2.0 * max(spread[best], 0.5)
    return best if is_clear and distances[best, best - 1] > OUTLIER_PX else 0


def _find_angles(cameras: Sequence[Camera], rays: Array, is_used: Mask) -> Array:
    """(N,) the largest angle between the lines of sight of two used views, degrees; NaN with fewer than two."""
    directions = np.stack([rays[:, c] @ camera.T_world_camera[:3, :3].T for c, camera in enumerate(cameras)], axis=1)
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    directions[~is_used] = np.nan
    sines = np.linalg.norm(np.cross(directions[:, :, None], directions[:, None, :]), axis=3)
    angles = np.degrees(np.arcsin(np.clip(np.nan_to_num(sines).max(axis=(1, 2), initial=0.0), 0.0, 1.0)))
    return np.where(is_used.sum(axis=1) >= 2, angles, np.nan)


def _refuse(num_marks: int, has_ray: Mask, angle_deg: float, distances: Array) -> str:
    """Why a point is not to be believed, or ''."""
    if num_marks < 2:
        return f"Marked in {num_marks} of the views; two are needed."
    if has_ray.sum() < 2:
        return "A mark lies outside what the camera's calibrated lens can show. Move it into the image."
    if angle_deg < MIN_ANGLE_DEG:
        return (
            f"The rays are nearly parallel ({angle_deg:.2f}°, needed {MIN_ANGLE_DEG:g}°), so they give no depth. "
            "Mark the joint in a camera that looks from elsewhere."
        )
    if not np.isfinite(distances).all():
        return "The rays do not meet in front of the cameras. Is it the same joint, and the same hand, in every view?"
    return ""


def _find_std(cameras: Sequence[Camera], points: Array, is_used: Mask) -> Array:
    H = np.zeros((len(points), 3, 3))
    for c, camera in enumerate(cameras):
        J = np.nan_to_num(_linearize(camera, points)[1])
        H += np.einsum("p,pri,prj->pij", is_used[:, c].astype(np.float64), J, J)
    smallest = np.linalg.eigvalsh(H)[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(smallest > 0, 1.0 / np.sqrt(np.maximum(smallest, 1e-300)), np.nan)

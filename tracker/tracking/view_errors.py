"""How well what each camera saw agrees with the fit, and with what the other cameras saw."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.triangulation import triangulate
from tracker.fitting.choose_views import choose_views
from tracker.fitting.view_hands import REACH
from tracker.geometry import se3
from tracker.terms.normal_equations import MILLIMETRES
from tracker.tracking.arrays_file import load_arrays, save_arrays

Array = npt.NDArray[np.float64]

MOSTLY = 0.5
"""A camera that the others outvote in a larger share of the joints is doubted."""

RARELY = 0.1
"""A camera that sees a hand in a smaller share of the frames in which the others see it hardly sees it."""


@dataclass(frozen=True)
class ViewErrors:
    """Of T frames, C cameras and H hands; NaN where nothing can be said.

    Attributes:
        camera_ids: (C,).
        fit_px: (T, C, H) median distance of the fitted joints to where the detector saw them; NaN of lost hands.
        left_out_px: (T, C, H) median distance of where the detector saw the joints to the points that the other
            cameras' detections make: large in one camera alone where it saw wrongly, moved, or lags behind.
        outvoted: (T, C, H) share of the joints seen in three cameras or more in which all others agree on a point that
            this one does not see there; NaN where there are none. Of three cameras side by side none is outvoted that
            is wrong along the line they stand on: each two of them agree somewhere.
        weight: (T, C, H) mean weight of the camera's viewing rays at the fit, 0 to 1 (`MarkedJoints`); 0 where it did
            not see the hand, NaN of lost hands and where it was not its turn to look (`choose_views`).
    """

    camera_ids: npt.NDArray[np.str_]
    fit_px: Array
    left_out_px: Array
    outvoted: Array
    weight: Array

    def save(self, path: Path) -> None:
        """Write an npz file, whole or not at all."""
        save_arrays(path, {field.name: getattr(self, field.name) for field in fields(self)})

    @classmethod
    def load(cls, path: Path) -> ViewErrors:
        """Read what `save` wrote.

        Raises:
            TrackingError: The file is not one of `save`.
        """
        return cls(**load_arrays(path, tuple(field.name for field in fields(cls))))

    def doubts(self) -> tuple[str, ...]:
        """A sentence for each camera whose calibration, clock or picture may be wrong."""
        said = []
        sees = np.asarray((self.weight > 0.0).any(axis=2))
        for number, camera in enumerate(self.camera_ids):
            by_others = np.delete(sees, number, axis=1).any(axis=1) & np.isfinite(self.weight[:, number]).any(axis=1)
            own = sees[by_others, number]
            outvoted = self.outvoted[:, number][np.isfinite(self.outvoted[:, number])]
            if own.size and own.mean() < RARELY:
                said.append(
                    f"{camera} saw a hand in {np.count_nonzero(own)} of {own.size} frames in which another camera saw "
                    "one: its picture may be mirrored, dark or turned away."
                )
            elif outvoted.size and outvoted.mean() > MOSTLY:
                said.append(
                    f"{camera} sees {100.0 * outvoted.mean():.0f} % of the joints elsewhere than all other cameras: it "
                    "may have moved since it was calibrated, be out of step, or mirrored."
                )
        return tuple(said)

    def summary(self) -> dict[str, dict[str, float | None]]:
        """Medians over frames and hands by camera."""
        return {
            str(camera): {
                name: _median(getattr(self, name)[:, number])
                for name in ("fit_px", "left_out_px", "outvoted", "weight")
            }
            for number, camera in enumerate(self.camera_ids)
        }


def measure_views(
    cameras: Sequence[Camera],
    frames: npt.NDArray[np.int64],
    seen: npt.NDArray[np.float32],
    joints: Array,
    lost: npt.NDArray[np.bool_],
) -> ViewErrors:
    """Compare what the detector saw with the fit and with the other cameras.

    Args:
        cameras: C of them.
        frames: (T,) their numbers.
        seen: (T, C, H, 21, 2) px as recorded; NaN where nothing was seen.
        joints: (T, H, 21, 3) of the fit, world, m.
        lost: (T, H) whether a hand was lost.
    """
    T, C, H = seen.shape[:3]
    fit, left_out, outvoted, weight = (np.full((T, C, H), np.nan) for _ in range(4))
    is_resting = np.ones((T, C), dtype=np.bool_)
    for row, frame in enumerate(frames):
        is_resting[row, choose_views(C, int(frame))] = False
    for hand in range(H):
        marks = seen[:, :, hand].astype(np.float64)  # (T, C, 21, 2)
        found = triangulate(cameras, marks.transpose(0, 2, 1, 3).reshape(-1, C, 2))
        left_out[:, :, hand] = _nanmedian(found.left_out_residuals.reshape(T, 21, C), axis=1)
        has_mark = np.asarray(np.isfinite(marks).all(axis=3)).transpose(0, 2, 1)  # (T, 21, C)
        can_tell = (has_mark.sum(axis=2) >= 3) & np.isfinite(found.points).all(axis=1).reshape(T, 21)
        is_out = has_mark & ~found.is_used.reshape(T, 21, C) & can_tell[:, :, None]
        told = np.count_nonzero(has_mark & can_tell[:, :, None], axis=1)
        outvoted[:, :, hand] = np.where(told > 0, np.count_nonzero(is_out, axis=1) / np.maximum(told, 1), np.nan)
        for number, camera in enumerate(cameras):
            points = joints[:, hand].reshape(-1, 3)
            own = marks[:, number].reshape(-1, 2)
            apart = np.linalg.norm(camera.project(points) - own, axis=1).reshape(T, 21)
            fit[:, number, hand] = _nanmedian(apart, axis=1)
            rays = camera.unproject(own)
            here = se3.transform(camera.T_camera_world, points)
            away = np.linalg.norm(np.cross(here, rays), axis=1) / np.linalg.norm(rays, axis=1)
            weights = 1.0 / (1.0 + (MILLIMETRES * away / REACH) ** 2) ** 2
            weight[:, number, hand] = np.nan_to_num(weights).reshape(T, 21).mean(axis=1)
        weight[:, :, hand][is_resting & ~np.isfinite(marks).any(axis=(2, 3))] = np.nan
        fit[lost[:, hand], :, hand] = weight[lost[:, hand], :, hand] = np.nan
    return ViewErrors(np.array([camera.id for camera in cameras], dtype=np.str_), fit, left_out, outvoted, weight)


def _nanmedian(values: Array, axis: int) -> Array:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # where all is NaN, NaN is the answer
        return np.asarray(np.nanmedian(values, axis=axis))


def _median(values: Array) -> float | None:
    known = values[np.isfinite(values)]
    return round(float(np.median(known)), 3) if known.size else None

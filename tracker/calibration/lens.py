"""A camera's lens: focal lengths, principal point and distortion, from the board in many poses."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board
from tracker.calibration.sightings import MIN_SIGHTINGS, Sightings
from tracker.errors import CalibrationError, reading

Array = npt.NDArray[np.float64]

LENS_VIEWS = 40
"""Of a board: more change a focal length by less than its standard deviation, and cost time that grows with them."""

FOCAL_STD = 0.3
"""Relative; of a start: adjusted with the other cameras it gets better, unless it is known less well than this."""

OTHER_FOCAL, TOLD = 1.5, 0.01
"""With so many times the focal length the residual must rise by this share, or the views tell no focal length: a board
that stays parallel to the picture looks the same near by through a short lens and far away through a long one."""

WORSE = 3.0
"""Times the median view's residual, beyond which a view is taken for a false one and left out."""


@dataclass(frozen=True, eq=False)
class Lens:
    """How a camera maps rays to pixels.

    Attributes:
        K: (3, 3) px, without skew.
        distortion: (n,) OpenCV: k1, k2, p1, p2, k3, and if there are more k4, k5, k6, and the thin prism.
        focal_std: Standard deviation of the focal length, px; 0 of a lens that was given.
    """

    K: Array
    distortion: Array
    focal_std: float = 0.0


def fit_lens(sightings: Sightings, board: Board) -> Lens:
    """A lens from one camera's sightings, after Zhang (2000), by OpenCV: a start, with k1 and k2 alone.

    The views are chosen to differ in place, size and tilt; one whose residual stands out is left out, once.

    Raises:
        CalibrationError: The views do not tell a lens; says what to film.
    """
    views = choose_views(sightings, LENS_VIEWS)
    lens, residuals = _fit(sightings, board, views)
    is_good = residuals <= max(WORSE * float(np.median(residuals)), 1.0)
    if MIN_SIGHTINGS <= is_good.sum() < len(views):
        views = views[is_good]
        lens, residuals = _fit(sightings, board, views)
    longer = _fit(sightings, board, views, OTHER_FOCAL * lens.K)[1]
    is_told = float(np.mean(longer**2)) > (1.0 + TOLD) ** 2 * float(np.mean(residuals**2))
    focal = lens.K[0, 0]
    longest = max(sightings.width, sightings.height)
    if not (0.1 * longest < focal < 50 * longest) or lens.focal_std > FOCAL_STD * focal or not is_told:
        raise CalibrationError(
            f"{sightings.camera}: its lens cannot be told from these {len(views)} views (focal length {focal:.0f} px, "
            f"± {lens.focal_std:.0f}). Film the board tilted by 30 to 45 degrees in several directions, near and far, "
            "and in the corners of the picture; or give known lenses with --lenses."
        )
    return lens


def choose_views(sightings: Sightings, most: int) -> npt.NDArray[np.int64]:
    """Places of at most `most` sightings that differ most: each one is the farthest from those before it.

    Two views differ by where the board is, how large it is and how its sides converge, all relative to the picture.
    """
    corners, is_seen = sightings.corners, np.isfinite(sightings.corners[:, :, 0])
    size = np.array([sightings.width, sightings.height])
    features = np.concatenate(
        [np.nanmean(corners, axis=1) / size, 2 * np.nanstd(corners, axis=1) / size, _find_shear(corners)[:, None]],
        axis=1,
    )
    enough = np.flatnonzero(is_seen.sum(axis=1) >= 0.5 * np.median(is_seen.sum(axis=1)))
    chosen = [int(enough[np.argmax(is_seen[enough].sum(axis=1))])]
    distance = np.full(len(features), -1.0)
    distance[enough] = np.inf
    while len(chosen) < min(most, len(enough)):
        distance = np.minimum(distance, np.linalg.norm(features - features[chosen[-1]], axis=1))
        chosen.append(int(np.argmax(np.where(np.isin(np.arange(len(features)), enough), distance, -1.0))))
    return np.array(sorted(set(chosen)))


def _find_shear(corners: Array) -> Array:
    """(S,) correlation of x and y over the corners: how the board is turned and tilted."""
    flat = corners - np.nanmean(corners, axis=1, keepdims=True)
    spread = np.nanstd(corners, axis=1)
    return np.nanmean(flat[..., 0] * flat[..., 1], axis=1) / np.maximum(spread[:, 0] * spread[:, 1], 1e-9)


def _fit(
    sightings: Sightings, board: Board, views: npt.NDArray[np.int64], fixed: Array | None = None
) -> tuple[Lens, Array]:
    """The lens and the residual of each view (px); with the focal length of a `fixed` K (3, 3), if there is one."""
    points, pixels = [], []
    for corners in sightings.corners[views]:
        is_seen = np.isfinite(corners[:, 0])
        points.append(board.corners[is_seen].astype(np.float32))
        pixels.append(corners[is_seen].astype(np.float32))
    needed = "a board seen in different places and tilts"
    with reading(CalibrationError, f"{sightings.camera}: {len(views)} views", needed):
        flags = cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST | cv2.CALIB_FIX_ASPECT_RATIO
        size = (sightings.width, sightings.height)
        start = np.eye(3)
        if fixed is not None:
            flags |= cv2.CALIB_USE_INTRINSIC_GUESS | cv2.CALIB_FIX_FOCAL_LENGTH
            start = np.array([[fixed[0, 0], 0, (size[0] - 1) / 2], [0, fixed[0, 0], (size[1] - 1) / 2], [0, 0, 1]])
        _, K, distortion, _, _, deviations, _, residuals = cv2.calibrateCameraExtended(
            points,
            pixels,
            size,
            start,
            np.zeros(5),
            flags=flags,
        )
    lens = Lens(np.asarray(K, float), np.ravel(distortion)[:5].astype(float), float(np.max(deviations[:2])))
    return lens, np.ravel(residuals).astype(float)

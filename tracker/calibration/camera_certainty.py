"""How certain the camera positions of a bundle adjustment are.

The covariance of the cameras is the inverse of the normal equations after the places are eliminated (Triggs et al.,
"Bundle adjustment, a modern synthesis", 2000, section 9). The first camera stands still, and something tells the scale:
boards, or a kept baseline.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array

from tracker.calibration.arrangement import Arrangement, Corners
from tracker.calibration.bundle import Freedom, Layout, find_jacobian
from tracker.calibration.eliminated_scale import EliminatedScale

Array = npt.NDArray[np.float64]

GRID = 3
"""Points looked at along each side of a picture: its corners, middles of its sides, and its centre."""


def find_covariance(J: csr_array, places: int, sigma_px: float) -> Array:
    """Covariance (n, n) of all parameters but the places, rad, m and shares of a focal length.

    Args:
        J: (R, places + n) Jacobian of the residuals.
        places: Its first so many columns are eliminated.
        sigma_px: Standard deviation of a mark in x and in y.
    """
    factor = EliminatedScale(J, places).factor
    back = solve_triangular(factor, np.eye(len(factor)), lower=True)
    return sigma_px**2 * back.T @ back


def find_pixel_std(cameras: Arrangement, number: int, freedom: Freedom, covariance: Array, depth: float) -> float:
    """How far a camera's picture may be off at worst, px: one standard deviation, anywhere in it, at a depth in m.

    Args:
        cameras: All cameras.
        number: Which.
        freedom: What the covariance is of.
        covariance: (n, n) as `find_covariance` gives it.
        depth: Of the points, m, along the camera's axis.
    """
    K, T = cameras.K[number], cameras.T_camera_world[number]
    width, height = cameras.sizes[number]
    columns, rows = np.meshgrid(np.linspace(0.0, width - 1.0, GRID), np.linspace(0.0, height - 1.0, GRID))
    flat = (np.column_stack([columns.ravel(), rows.ravel()]) - K[:2, 2]) / [K[0, 0], K[1, 1]]
    points = depth * np.column_stack([flat, np.ones(len(flat))])
    places = np.tile(np.eye(4), (len(points), 1, 1))
    places[:, :3, 3] = (points - T[:3, 3]) @ T[:3, :3]
    here, layout = replace(cameras, T_world_board=places), Layout(len(cameras.K), len(points), freedom)
    nothing = np.zeros((len(points), 3))
    corners = Corners(np.full(len(points), number), np.arange(len(points)), nothing, nothing[:, :2], nothing[:, :2])
    J = find_jacobian(here, layout, corners, freedom, np.zeros(layout.size)).toarray()
    J = J[: 2 * len(points), layout.places :].reshape(len(points), 2, -1)
    spread = np.einsum("pri,ij,psj->prs", J, covariance, J)
    return float(np.sqrt(np.linalg.eigvalsh(spread)[:, -1].max()))

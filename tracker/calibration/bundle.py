"""Bundle adjustment: cameras, lenses, time offsets and boards together, so that all corners are where they were seen.

Minimises the robust distance in the pictures (Triggs et al., "Bundle adjustment, a modern synthesis", 2000) by scipy's
`least_squares`. Its Jacobian is sparse and by finite differences: a corner depends on its camera and its board alone,
so one difference serves all boards at once, another all cameras. A camera that is `d` seconds later than the start saw
a corner `d` times its velocity farther along (Qin and Shen, "Online temporal calibration for monocular visual-inertial
systems", 2018).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares
from scipy.sparse import coo_array, csr_array

from tracker.calibration.arrangement import Arrangement, Corners
from tracker.calibration.eliminated_scale import EliminatedScale
from tracker.calibration.projection import turn_vectors

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

LENS_PARAMETERS = 9
"""fx, fy, cx, cy, k1, k2, p1, p2, k3; others stay as they are."""

ROBUST_PX = 1.0
"""Residuals larger than this count less and less; corners are found to a quarter of it."""

STEP = 1e-6
"""Of the finite differences, in radians, metres, seconds and shares of a focal length; a camera that is 1 m away sees
thousandths of a pixel change, of which double precision leaves seven digits."""

ASPECT_STD, CENTRE_STD = 0.01, 0.05
"""What is expected of a lens before a board is seen: pixels are square to a hundredth, and the principal point is in
the middle to a twentieth of the picture's longer side. It counts as much as a residual of 1 px: hundreds of corners all
over the picture override it, a board that was never near the borders does not make up a lens there."""

DISTORTION_STD = (0.5, 0.5, 0.005, 0.005, 0.2)
"""Likewise of k1, k2, p1, p2, k3."""

BASELINE_STD = 1e-4
"""Of a kept baseline, as a share of it. Nothing in the pictures pulls at it, so it is met whatever this is."""

OF_LENS, OF_BASELINE = -1, -2
"""In place of the moment: residuals that no board touches."""


@dataclass(frozen=True)
class Freedom:
    """What may change besides the boards' places.

    Attributes:
        cameras: All cameras' places but the first's.
        lenses: Their lenses.
        offsets: All time offsets but the first's.
        kept_baseline: A camera's number and its distance from the first camera, m, that stays; None where boards of
            known size tell the scale.
    """

    cameras: bool = True
    lenses: bool = True
    offsets: bool = True
    kept_baseline: tuple[int, float] | None = None


def adjust(start: Arrangement, corners: Corners, freedom: Freedom, robust_px: float = ROBUST_PX) -> Arrangement:
    """The arrangement of least cost, from a start near it.

    Args:
        start: Every camera and every place of the board that a corner names.
        corners: Those to be met.
        freedom: What may change.
        robust_px: Where the loss turns from quadratic to linear.
    """
    if len(corners.camera) == 0:
        return start
    layout = Layout(len(start.K), len(start.T_world_board), freedom)

    def measure(x: Array) -> Array:
        return find_residuals(_move(start, layout, x), corners, freedom)

    def differentiate(x: Array) -> csr_array:
        return find_jacobian(start, layout, corners, freedom, x)

    scale = EliminatedScale(differentiate(np.zeros(layout.size)), layout.places)
    answer = least_squares(
        lambda y: measure(scale.apply(y)),
        np.zeros(layout.size),
        jac=lambda y: scale.compose(differentiate(scale.apply(y))),  # pyright: ignore[reportArgumentType]
        loss="soft_l1",
        f_scale=robust_px,
        method="trf",
        tr_solver="lsmr",
        ftol=1e-5,
        xtol=1e-9,
        gtol=1e-9,
        max_nfev=40,
    )
    return _move(start, layout, scale.apply(answer.x))


def find_residuals(cameras: Arrangement, corners: Corners, freedom: Freedom) -> Array:
    """(2 M,) px; after them, in standard deviations, what is odd about free lenses (8 C,) and a kept baseline (1,)."""
    parts = [cameras.residuals(corners).ravel()]
    if freedom.lenses:
        fx, fy = cameras.K[:, 0, 0], cameras.K[:, 1, 1]
        middle = (cameras.sizes - 1.0) / 2.0
        away = (cameras.K[:, :2, 2] - middle) / (CENTRE_STD * cameras.sizes.max(axis=1, keepdims=True))
        odd = np.column_stack([(fx / fy - 1.0) / ASPECT_STD, away, cameras.distortion[:, :5] / DISTORTION_STD])
        parts.append(odd.ravel())
    if freedom.kept_baseline is not None:
        number, length = freedom.kept_baseline
        parts.append((cameras.find_baselines()[[number]] / length - 1.0) / BASELINE_STD)
    return np.concatenate(parts)


def find_jacobian(start: Arrangement, layout: Layout, corners: Corners, freedom: Freedom, x: Array) -> csr_array:
    """Derivatives of `find_residuals` by the parameters, forward differences (residuals, parameters)."""
    here = find_residuals(_move(start, layout, x), corners, freedom)
    of_lens = np.repeat(np.arange(layout.cameras), 8) if freedom.lenses else np.zeros(0, dtype=np.int64)
    kept = [] if freedom.kept_baseline is None else [freedom.kept_baseline[0]]
    camera = np.concatenate([np.repeat(corners.camera, 2), of_lens, np.array(kept, dtype=np.int64)])
    moment = np.concatenate(
        [np.repeat(corners.moment, 2), np.full(len(of_lens), OF_LENS), np.full(len(kept), OF_BASELINE)]
    )
    assert len(camera) == len(here)
    rows = np.arange(len(here))
    parts = []
    for columns, which in layout.groups(camera, moment):
        step = np.zeros(layout.size)
        step[columns] = STEP
        change = (find_residuals(_move(start, layout, x + step), corners, freedom) - here) / STEP
        is_hit = which >= 0
        parts.append((change[is_hit], rows[is_hit], which[is_hit]))
    values, at_rows, at_columns = (np.concatenate(part) for part in zip(*parts, strict=True))
    return csr_array(coo_array((values, (at_rows, at_columns)), shape=(len(here), layout.size)))


class Layout:
    """Where each unknown is among the parameters."""

    def __init__(self, cameras: int, boards: int, freedom: Freedom) -> None:
        self.cameras, self.boards = cameras, boards
        self.places = 6 * boards
        self.offsets = self.places + (6 * (cameras - 1) if freedom.cameras else 0)
        self.lenses = self.offsets + (cameras - 1 if freedom.offsets else 0)
        self.size = self.lenses + (LENS_PARAMETERS * cameras if freedom.lenses else 0)

    def groups(self, camera: Integers, moment: Integers) -> Iterator[tuple[Integers, Integers]]:
        """Parameters no two of which touch one residual, and for each residual (R,) which of them does, or -1."""
        for part in range(6):
            yield np.arange(part, self.places, 6), np.where(moment >= 0, 6 * moment + part, -1)
        is_other = (moment != OF_LENS) & (camera > 0)
        for part in range(6 if self.offsets > self.places else 0):
            which = np.where(is_other, self.places + 6 * (camera - 1) + part, -1)
            yield np.arange(self.places + part, self.offsets, 6), which
        if self.lenses > self.offsets:
            yield np.arange(self.offsets, self.lenses), np.where(is_other, self.offsets + camera - 1, -1)
        for part in range(LENS_PARAMETERS if self.size > self.lenses else 0):
            yield (
                np.arange(self.lenses + part, self.size, LENS_PARAMETERS),
                self.lenses + LENS_PARAMETERS * camera + part,
            )


def _move(start: Arrangement, layout: Layout, x: Array) -> Arrangement:
    """The start moved by the parameters; turns and moves of boards and cameras are small and about the start."""
    moved = replace(start, T_world_board=_step(start.T_world_board, x[: layout.places].reshape(-1, 6)))
    if layout.offsets > layout.places:
        steps = np.concatenate([np.zeros(6), x[layout.places : layout.offsets]]).reshape(-1, 6)
        moved = replace(moved, T_camera_world=_step(start.T_camera_world, steps))
    if layout.lenses > layout.offsets:
        moved = replace(moved, offsets=start.offsets + np.concatenate([[0.0], x[layout.offsets : layout.lenses]]))
    if layout.size > layout.lenses:
        lens = x[layout.lenses :].reshape(-1, LENS_PARAMETERS)
        K, distortion = start.K.copy(), start.distortion.copy()
        K[:, 0, 0] *= 1.0 + lens[:, 0]
        K[:, 1, 1] *= 1.0 + lens[:, 1]
        K[:, 0, 2] += lens[:, 2] * start.K[:, 0, 0]
        K[:, 1, 2] += lens[:, 3] * start.K[:, 1, 1]
        distortion[:, :5] += lens[:, 4:]
        moved = replace(moved, K=K, distortion=distortion)
    return moved


def _step(T: Array, steps: Array) -> Array:
    """T (n, 4, 4) turned by rotation vectors and moved, steps (n, 6): turn, then move."""
    moved = T.copy()
    moved[:, :3, :3] = turn_vectors(steps[:, :3]) @ T[:, :3, :3]
    moved[:, :3, 3] += steps[:, 3:]
    return moved

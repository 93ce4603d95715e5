"""The depth a structured-light sensor of the Carmine kind would report of an exactly known surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class StructuredLight:
    """Noise and gaps of a structured-light depth sensor.

    Axial and lateral noise follow C. V. Nguyen, S. Izadi, D. Lovell, "Modeling Kinect sensor noise for improved 3D
    reconstruction and tracking", 3DIMPVT 2012, measured on the sensor family that [T16] used; quantisation and the
    projector's shadow follow from triangulation, as in K. Khoshelham, S. Oude Elberink, "Accuracy and resolution of
    Kinect depth data", Sensors 12, 2012. Noise is independent from pixel to pixel; a real sensor's is not quite.

    Attributes:
        baseline: Projector to camera, m; the projector stands to the right (+X).
        disparity_step: Resolution of the disparity, px.
        lateral: Standard deviation of the place on the image where a pixel really looks, px; shows at edges only.
        edge_distance: A step in depth of more than this between neighbours is an edge, m.
        edge_loss: Share of pixels lost at an edge.
        grazing_cosine: Below this cosine between ray and normal nothing returns; up to twice of it, less and less.
        random_loss: Share of pixels lost anywhere.
    """

    baseline: float = 0.075
    disparity_step: float = 0.125
    lateral: float = 0.8
    edge_distance: float = 0.010
    edge_loss: float = 0.3
    grazing_cosine: float = 0.15
    random_loss: float = 0.001

    def axial_std(self, depth: Array) -> Array:
        """Standard deviation along the optical axis, m, at depth z, m: 1.2 mm + 1.9 mm/m² (z - 0.4 m)²."""
        return 0.0012 + 0.0019 * (depth - 0.4) ** 2

    def measure(self, depth: Array, cosine: Array, fx: float, rng: np.random.Generator) -> Array:
        """What the sensor reports.

        Args:
            depth: (H, W) exact, m; 0 where nothing is.
            cosine: (H, W) between the surface normal and the direction to the camera; read where there is depth.
            fx: Focal length, px.
            rng: Source of chance.

        Returns:
            (H, W) m; 0 where the sensor has no value.
        """
        assert depth.shape == cosine.shape
        reported = np.zeros_like(depth)
        rows, columns = _box(depth > 0, margin=4)
        if rows.start == rows.stop:
            return reported
        near, facing = depth[rows, columns], cosine[rows, columns]
        is_lost = self._find_shadow(near, fx) | (rng.random(near.shape) < self.random_loss)
        is_lost |= rng.random(near.shape) < np.clip(2.0 - facing / self.grazing_cosine, 0.0, 1.0)
        is_lost |= self._find_edges(near) & (rng.random(near.shape) < self.edge_loss)

        # A pixel looks a little beside its centre.
        shift = np.rint(rng.normal(0.0, self.lateral, (2, *near.shape))).astype(np.int64)
        row, column = np.indices(near.shape)
        row = np.clip(row + shift[0], 0, near.shape[0] - 1)
        column = np.clip(column + shift[1], 0, near.shape[1] - 1)
        beside = near[row, column]
        # Within a surface that would only copy the neighbour's depth, which axial noise already covers.
        measured = np.where(np.abs(beside - near) > self.edge_distance, beside, near)

        has_value = (measured > 0) & ~is_lost
        noisy = measured + rng.normal(0.0, 1.0, near.shape) * self.axial_std(measured)
        constant = fx * self.baseline
        disparity = constant / np.where(has_value, noisy, 1.0)
        steps = np.maximum(np.rint(disparity / self.disparity_step), 1.0)
        reported[rows, columns] = np.where(has_value, constant / (steps * self.disparity_step), 0.0)
        return reported

    def _find_shadow(self, depth: Array, fx: float) -> npt.NDArray[np.bool_]:
        """Pixels that the projector does not reach: something further right covers their column of the pattern."""
        seen_by_projector = np.arange(depth.shape[1]) - fx * self.baseline / np.where(depth > 0, depth, np.inf)
        seen_by_projector[depth <= 0] = np.inf
        nearest_right = np.minimum.accumulate(seen_by_projector[:, ::-1], axis=1)[:, ::-1]
        is_shadow = np.zeros(depth.shape, dtype=bool)
        is_shadow[:, :-1] = seen_by_projector[:, :-1] > nearest_right[:, 1:]
        return is_shadow & (depth > 0)

    def _find_edges(self, depth: Array) -> npt.NDArray[np.bool_]:
        """Pixels with a neighbour at another depth, or with none."""
        is_edge = np.zeros(depth.shape, dtype=bool)
        across = np.abs(np.diff(depth, axis=1)) > self.edge_distance
        down = np.abs(np.diff(depth, axis=0)) > self.edge_distance
        is_edge[:, 1:] |= across
        is_edge[:, :-1] |= across
        is_edge[1:] |= down
        is_edge[:-1] |= down
        return is_edge


def _box(mask: npt.NDArray[np.bool_], margin: int) -> tuple[slice, slice]:
    """Rows and columns of the smallest box around a mask (H, W), with a margin in px; empty slices for none."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if len(rows) == 0:
        return slice(0, 0), slice(0, 0)
    return (
        slice(max(0, int(rows[0]) - margin), min(mask.shape[0], int(rows[-1]) + margin + 1)),
        slice(max(0, int(columns[0]) - margin), min(mask.shape[1], int(columns[-1]) + margin + 1)),
    )

"""An image in which fingertips are looked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.ndimage import distance_transform_edt

from tracker.observation import HAND, Observation


@dataclass(frozen=True)
class PatchImage:
    """Depth, and colour where the forest looks at colour, of the whole image or a part of it.

    Attributes:
        depth: (H, W) float32, m; 0 where nothing is known. It sets the scale of every patch.
        mask: (H, W) bool, pixels on which a patch may be centred.
        focal: Focal length, px.
        color: (H, W, 3) uint8 RGB, or None.
    """

    depth: npt.NDArray[np.float32]
    mask: npt.NDArray[np.bool_]
    focal: float
    color: npt.NDArray[np.uint8] | None = None

    def __post_init__(self) -> None:
        assert self.depth.ndim == 2 and self.mask.shape == self.depth.shape
        assert self.color is None or self.color.shape == (*self.depth.shape, 3)

    @classmethod
    def of(cls, observation: Observation) -> PatchImage:
        """The hand's pixels of an observation; what colour tells to be something else is taken out of the depth."""
        mask = (observation.labels & HAND) > 0
        depth = np.where(mask, observation.depth, np.float32(0.0))
        return cls(depth, mask, float(observation.K[0, 0]), observation.color)

    @classmethod
    def around(
        cls, depth: npt.NDArray[np.float32], color: npt.NDArray[np.uint8], focal: float, margin: float
    ) -> PatchImage:
        """A colour image without depth of its own: hands as they are drawn where they are expected, and what is near.

        Only blue is kept, in which nails are most unlike skin.

        Args:
            depth: (H, W) of the drawn hands, m; 0 elsewhere. Pixels beside them get that of the nearest.
            color: (H, W, 3) RGB.
            focal: px.
            margin: Farther from the hands than this no patch is taken, m.
        """
        away, (rows, columns) = distance_transform_edt(depth <= 0.0, return_indices=True)  # type: ignore[misc]
        filled = depth[rows, columns]
        mask = (filled > 0.0) & (away * filled <= margin * focal)
        blue = np.repeat(color[:, :, 2:], 3, axis=2)
        return cls(np.where(mask, filled, np.float32(0.0)).astype(np.float32), mask, focal, blue)

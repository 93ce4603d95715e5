"""Which hulls of hands and object are near enough to each other to be worth a collision check."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.physics.hulls import BoneHull

Array = npt.NDArray[np.float64]


class HullPairs:
    """Pairs of a still hull and one of the object's, told apart by separating planes.

    Args:
        still: Hulls of what stands still.
        moving: Hulls of the object.
    """

    def __init__(self, still: Sequence[BoneHull], moving: Sequence[BoneHull]) -> None:
        none = np.zeros((0, 3))
        self._still_radii = np.array([hull.radius for hull in still])
        self._moving_radii = np.array([hull.radius for hull in moving])
        self._vertices = np.concatenate([none, *(hull.vertices for hull in still)])
        self._planes = np.concatenate([hull.planes for hull in moving])
        self._vertex_starts = np.cumsum([0, *(len(hull.vertices) for hull in still)])
        self._plane_starts = np.cumsum([0, *(len(hull.planes) for hull in moving)])

    def find_near(
        self, still_Rs: Array, still_centers: Array, moving_Rs: Array, moving_centers: Array, reach: float
    ) -> npt.NDArray[np.bool_]:
        """(S, M) whether a still hull may be within `reach`, m, of a hull of the object.

        No pair within reach is left out; a pair a little farther may be let in.

        Args:
            still_Rs: (S, 3, 3) world.
            still_centers: (S, 3) world, m.
            moving_Rs: (M, 3, 3) world.
            moving_centers: (M, 3) world, m.
            reach: m.
        """
        near = np.ones((len(self._still_radii), len(self._moving_radii)), dtype=np.bool_)
        if np.isfinite(reach) and near.size:
            _find_into(
                near,
                (self._still_radii, self._vertices, self._vertex_starts),
                (self._moving_radii, self._planes, self._plane_starts),
                (np.ascontiguousarray(still_Rs), still_centers),
                (np.ascontiguousarray(moving_Rs), moving_centers),
                reach,
            )
        return near


@njit(cache=True, nogil=True)
def _find_into(near, still, moving, still_poses, moving_poses, reach):
    """Two hulls are apart by at least what all vertices of one lie beyond a face of the other."""
    still_radii, vertices, vertex_starts = still
    moving_radii, planes, plane_starts = moving
    Rs, centers = still_poses
    object_Rs, places = moving_poses
    turned = np.zeros((len(vertices), 3))
    for s in range(len(still_radii)):
        first, last = vertex_starts[s], vertex_starts[s + 1]
        for m in range(len(moving_radii)):
            offset = centers[s] - places[m]
            between = np.sqrt(offset[0] ** 2 + offset[1] ** 2 + offset[2] ** 2)
            if between - still_radii[s] - moving_radii[m] > reach:
                near[s, m] = False
                continue
            for v in range(first, last):
                x, y, z = offset[0], offset[1], offset[2]
                x += Rs[s, 0, 0] * vertices[v, 0] + Rs[s, 0, 1] * vertices[v, 1] + Rs[s, 0, 2] * vertices[v, 2]
                y += Rs[s, 1, 0] * vertices[v, 0] + Rs[s, 1, 1] * vertices[v, 1] + Rs[s, 1, 2] * vertices[v, 2]
                z += Rs[s, 2, 0] * vertices[v, 0] + Rs[s, 2, 1] * vertices[v, 1] + Rs[s, 2, 2] * vertices[v, 2]
                for axis in range(3):
                    turned[v, axis] = object_Rs[m, 0, axis] * x + object_Rs[m, 1, axis] * y + object_Rs[m, 2, axis] * z
            for p in range(plane_starts[m], plane_starts[m + 1]):
                lowest = np.inf
                for v in range(first, last):
                    height = planes[p, 3]
                    for axis in range(3):
                        height += planes[p, axis] * turned[v, axis]
                    lowest = min(lowest, height)
                    if lowest <= reach:
                        break
                if lowest > reach:
                    near[s, m] = False
                    break

"""Rotations from which the pose of a rigid object is looked for: few where the object looks the same turned."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

Array = npt.NDArray[np.float64]

SAMPLES = 200
"""Points of a surface that turned surfaces are compared by."""

SAME = 0.03
"""Surfaces whose mean distance is below this share of their size look the same to a search."""


def sample_surface(vertices: Array, faces: npt.NDArray, count: int = SAMPLES) -> Array:
    """(count, 3) points spread over a surface by its area, the same every time."""
    corners = vertices[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    ends = np.cumsum(areas)
    where = (np.arange(count) + 0.5) / count * ends[-1]
    chosen = np.minimum(np.searchsorted(ends, where), len(faces) - 1)
    index = np.arange(count)
    u, v = (index * 0.7548776662466927) % 1.0, (index * 0.5698402909980532) % 1.0  # R2 sequence
    root = np.sqrt(u)
    shares = np.stack([1.0 - root, root * (1.0 - v), root * v], axis=1)
    return np.einsum("nk,nkx->nx", shares, corners[chosen])


def spread_rotations(count: int) -> Array:
    """(count, 3, 3) rotations spread evenly over all there are: super-Fibonacci spirals (Alexa, CVPR 2022)."""
    s = np.arange(count) + 0.5
    inner, outer = np.sqrt(s / count), np.sqrt(1.0 - s / count)
    alpha, beta = 2.0 * np.pi * s / np.sqrt(2.0), 2.0 * np.pi * s / 1.533751168755204288118041
    xyzw = np.stack([inner * np.sin(alpha), inner * np.cos(alpha), outer * np.sin(beta), outer * np.cos(beta)], axis=1)
    return Rotation.from_quat(xyzw).as_matrix()


def propose_rotations(points: Array, rotations: Array) -> Array:
    """Of rotations (N, 3, 3), one of all that make a surface with these sampled points (S, 3) look the same.

    Surfaces are compared by the mean distance from each point to the nearest of the other, about the points' mean.
    """
    centered = points - points.mean(axis=0)
    size = 2.0 * float(np.linalg.norm(centered, axis=1).max())
    # Samples of one surface are themselves apart; this much distance says nothing.
    spacing = float(np.mean(KDTree(centered).query(centered, k=2)[0][:, 1]))
    kept: list[int] = []
    trees: list[KDTree] = []
    for index, R in enumerate(rotations):
        turned = centered @ R.T
        if any(float(np.mean(tree.query(turned)[0])) < SAME * size + 0.5 * spacing for tree in trees):
            continue
        kept.append(index)
        trees.append(KDTree(turned))
    return rotations[kept]

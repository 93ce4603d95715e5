"""Pose blend shapes of an articulated model: its surface at rest changes with the pose before it is skinned."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.blend_kernels import FAST

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

NEGLIGIBLE = 1e-5
"""A bone that can move a vertex by no more than this is left out of it, m."""

LARGEST_CHANGE = np.sqrt(8.0)
"""Frobenius norm of R - I for a half turn; no rotation has a larger one."""


@dataclass(frozen=True)
class PoseBlend:
    """Offsets of the surface at rest by the elements of each bone's rotation against its parent, [R17] Eq. 3.

    Attributes:
        bones: (K,) of the model's skeleton.
        directions: (V, 3, 9K) m, by the elements of R_k - I, row by row, axes of the model frame.
    """

    bones: npt.NDArray[np.int64]
    directions: Array

    def __post_init__(self) -> None:
        assert self.directions.shape[1:] == (3, 9 * len(self.bones)), self.directions.shape


class PoseBlendArrays(NamedTuple):
    """The pose blend shapes of a scene, flat for the kernel.

    vertices (N,) places in the scene's vertices; starts (N + 1,), bones and parents (M,) places in the scene's bones,
    blocks (M, 3, 9) those of each vertex.
    """

    vertices: Ints
    starts: Ints
    bones: Ints
    parents: Ints
    blocks: Array


def stack_pose_blend(
    blend: PoseBlend, sources: npt.NDArray, places: npt.NDArray, parents: npt.NDArray, first_bone: int
) -> PoseBlendArrays:
    """Those of one model in a scene.

    Args:
        blend: The model's.
        sources: (N,) vertices of the model.
        places: (N,) where each of them stands in the scene.
        parents: (B,) of the model's bones.
        first_bone: Of the model in the scene.
    """
    blocks = blend.directions[sources].reshape(len(sources), 3, len(blend.bones), 9).transpose(0, 2, 1, 3)
    used = LARGEST_CHANGE * np.linalg.norm(blocks, axis=(2, 3)) > NEGLIGIBLE
    bones = blend.bones[np.nonzero(used)[1]]
    return PoseBlendArrays(
        vertices=places.astype(np.int32),
        starts=np.concatenate([[0], np.cumsum(used.sum(axis=1))]).astype(np.int32),
        bones=(bones + first_bone).astype(np.int32),
        parents=(parents[bones] + first_bone).astype(np.int32),
        blocks=np.ascontiguousarray(blocks[used]),
    )


def join_pose_blends(parts: list[PoseBlendArrays]) -> PoseBlendArrays:
    """One behind the other."""
    ends = np.cumsum([0, *(len(part.blocks) for part in parts)])
    starts = [part.starts[:-1] + end for part, end in zip(parts, ends[:-1], strict=True)]
    return PoseBlendArrays(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([*starts, ends[-1:]]).astype(np.int32),
        np.concatenate([part.bones for part in parts]),
        np.concatenate([part.parents for part in parts]),
        np.concatenate([part.blocks for part in parts]),
    )


@njit(cache=True, nogil=True, fastmath=FAST)
def add_pose_blend(rest: Array, Ms: Array, features: Array, arrays: PoseBlendArrays) -> None:
    """Add what the pose does to the surface at rest (V, 3), m.

    Args:
        rest: Changed.
        Ms: (B, 3, 4) motion of each bone from rest.
        features: (B, 9) scratch.
        arrays: The pose blend shapes.
    """
    features[:, 0] = np.nan
    for m in range(len(arrays.bones)):
        bone, parent = arrays.bones[m], arrays.parents[m]
        if np.isnan(features[bone, 0]):
            for r in range(3):
                for c in range(3):
                    turned = -1.0 if r == c else 0.0
                    for x in range(3):
                        turned += Ms[parent, x, r] * Ms[bone, x, c]
                    features[bone, 3 * r + c] = turned
    blocks = arrays.blocks
    for n in range(len(arrays.vertices)):
        x = y = z = 0.0
        for m in range(arrays.starts[n], arrays.starts[n + 1]):
            bone = arrays.bones[m]
            for k in range(9):
                feature = features[bone, k]
                x += blocks[m, 0, k] * feature
                y += blocks[m, 1, k] * feature
                z += blocks[m, 2, k] * feature
        v = arrays.vertices[n]
        rest[v, 0] += x
        rest[v, 1] += y
        rest[v, 2] += z

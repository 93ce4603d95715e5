"""Pose blend shapes of a model: its surface at rest changes with the pose before it is skinned."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.skinning import Array, PoseBlendArrays

NEGLIGIBLE = 1e-5
"""A bone that can move a vertex by no more than this is left out of it where hands are tracked, m."""

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


def stack_pose_blend(
    directions: Array, bones: npt.NDArray, places: npt.NDArray | None = None, negligible: float = 0.0
) -> PoseBlendArrays:
    """Pose blend shapes, flat for the kernels.

    Args:
        directions: (N, 3, 9K) m.
        bones: (K,).
        places: (N,) whose they are; vertices 0 to N - 1 when left out.
        negligible: A bone that can move a vertex by no more than this is left out of it, m.
    """
    blocks = directions.reshape(len(directions), 3, len(bones), 9).transpose(0, 2, 1, 3)
    used = LARGEST_CHANGE * np.linalg.norm(blocks, axis=(2, 3)) > negligible
    owners, columns = np.nonzero(used)
    counts = used.sum(axis=1)
    starts = np.concatenate([[0], np.cumsum(counts)])
    r, k = np.indices((3, 9))
    first, width, within = (
        each[:, None, None] for each in (starts[owners], 9 * counts[owners], np.arange(len(owners)))
    )
    flat = np.empty(27 * len(owners))
    flat[27 * first + width * r + 9 * (within - first) + k] = blocks[used]
    return PoseBlendArrays(
        vertices=np.asarray(np.arange(len(directions)) if places is None else places, dtype=np.int32),
        starts=starts.astype(np.int32),
        bones=bones[columns].astype(np.int32),
        blocks=flat,
    )


def join_pose_blends(parts: list[PoseBlendArrays]) -> PoseBlendArrays:
    """One behind the other."""
    ends = np.cumsum([0, *(len(part.bones) for part in parts)])
    starts = [part.starts[:-1] + end for part, end in zip(parts, ends[:-1], strict=True)]
    return PoseBlendArrays(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([*starts, ends[-1:]]).astype(np.int32),
        np.concatenate([part.bones for part in parts]),
        np.concatenate([part.blocks for part in parts]),
    )

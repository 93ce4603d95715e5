"""What a pose does to a surface at rest, as a few morph targets and their weights over a track."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import ArticulatedModel
from tracker.model.pose_blend import PoseBlend

Array = npt.NDArray[np.float64]

CLOSE = 1e-4
"""m: no vertex of any frame is farther than this from where the pose blend shapes put it, before skinning."""


class PoseMorphs(NamedTuple):
    """targets (K, V, 3) offsets at rest, m; weights (T, K) of each frame, zero at rest."""

    targets: Array
    weights: Array


def find_pose_morphs(model: ArticulatedModel, motions: Array) -> PoseMorphs | None:
    """Those of an articulated model; None for one that is only skinned.

    Args:
        model: Any.
        motions: (T, B, 4, 4) of its bones from rest.
    """
    return None if model.pose_blend is None else choose_morphs(model.pose_blend, model.skeleton.parents, motions)


def choose_morphs(blend: PoseBlend, parents: npt.NDArray[np.int64], motions: Array) -> PoseMorphs:
    """As few targets as come close to every frame.

    The blend shapes are linear in the bones' rotations; of the space that a track goes through there the largest
    singular directions are kept.

    Args:
        blend: The pose blend shapes.
        parents: (B,) of the bones.
        motions: (T, B, 4, 4) of the bones from rest.
    """
    Rs = motions[:, :, :3, :3]
    turns = np.swapaxes(Rs[:, parents[blend.bones]], -1, -2) @ Rs[:, blend.bones] - np.eye(3)
    features = turns.reshape(len(turns), -1)
    directions = blend.directions.reshape(-1, blend.directions.shape[2])
    basis, small = np.linalg.qr(directions)
    left, sizes, right = np.linalg.svd(features @ small.T, full_matrices=False)
    for count in range(1, len(sizes) + 1):
        missed = (left[:, count:] * sizes[count:]) @ right[count:] @ basis.T
        if np.linalg.norm(missed.reshape(len(features), -1, 3), axis=2).max(initial=0.0) < CLOSE:
            break
    scales = np.maximum(sizes[:count], 1e-12) * np.abs(left[:, :count]).max(axis=0)  # so that weights stay within ±1
    weights = left[:, :count] * sizes[:count] / scales
    return PoseMorphs((scales[:, None] * (right[:count] @ basis.T)).reshape(count, -1, 3), weights)

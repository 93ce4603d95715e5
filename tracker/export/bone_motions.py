"""How the bones of a track moved, frame by frame."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.tracking.track import Track

Array = npt.NDArray[np.float64]


def find_bone_motions(track: Track) -> Array:
    """(T, B, 4, 4) motion of each bone of the scene from rest to world, m; the bones of all models in order."""
    scene = track.setup.scene
    motions = np.zeros((len(track.frame), scene.bone_slices[-1].stop, 4, 4))
    motions[..., 3, 3] = 1.0
    for row, pose in enumerate(track.pose):
        motions[row, :, :3] = scene.pose_at(pose).Ms
    return motions

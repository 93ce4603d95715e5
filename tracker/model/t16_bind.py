"""Where the bones of a T16 model are at rest: read from a motion, or else worked out from the model's other files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.model.skeleton import Array


def find_motion_beside(off_path: Path) -> Path | None:
    """A MOTION file of this model: in its own folder or in `../seq/*/`."""
    stem = off_path.stem
    for pattern in (f"{stem}.MOTION*", f"../seq/*/{stem}.MOTION*"):
        for found in sorted(off_path.parent.glob(pattern)):
            if found.suffix in (".MOTION", ".gz") and found.is_file():
                return found
    return None


def estimate_bind(
    vertices: Array,
    weights: Array,
    parents: npt.NDArray[np.int64],
    lengths: Array,
    palm_sides: dict[int, Array],
) -> Array:
    """Rest poses (B, 4, 4) of the bones from the mesh and its weights alone.

    A joint is where the weights of a bone and its parent overlap, moved along the bone until the length in the
    .SKEL file fits. A bone's first axis runs along it; the third is square to it and to where the palm looks,
    which in T16's files is the flexion axis to within 10 degrees.

    Args:
        vertices: (V, 3).
        weights: (V, B).
        parents: (B,).
        lengths: (B,) from a bone's joint to that of its child.
        palm_sides: For a bone of a hand, (3,) the direction its palm side looks in.
    """
    num_bones = len(parents)
    children = [np.flatnonzero(parents == bone) for bone in range(num_bones)]
    joints = np.zeros((num_bones, 3))
    for bone in range(num_bones):
        joints[bone] = _weighted_joint(vertices, weights, bone, int(parents[bone]))
    for bone in range(num_bones):
        if parents[bone] >= 0 and len(children[bone]) == 1:
            child = int(children[bone][0])
            along = joints[child] - joints[bone]
            distance = np.linalg.norm(along)
            if distance > 0:
                excess = 0.5 * (distance - lengths[bone]) / distance * along
                joints[bone] = joints[bone] + excess
                joints[child] = joints[child] - excess
    Ts = np.tile(np.eye(4), (num_bones, 1, 1))
    Ts[:, :3, 3] = joints
    for bone in range(num_bones):
        if parents[bone] < 0:
            continue
        follows = weights[:, bone] > 0.5
        end = (
            joints[children[bone][0]]
            if len(children[bone])
            else vertices[follows].mean(axis=0)
            if follows.any()
            else joints[bone]
        )
        Ts[bone, :3, :3] = _frame(end - joints[bone], palm_sides.get(bone))
    return Ts


def _weighted_joint(vertices: Array, weights: Array, bone: int, parent: int) -> Array:
    if parent < 0:
        shared = weights[:, bone]
    else:
        shared = weights[:, bone] * weights[:, parent]
        if shared.sum() < 1e-6:
            shared = weights[:, bone]
    total = shared.sum()
    return (shared @ vertices) / total if total > 0 else vertices.mean(axis=0)


def _frame(along: Array, palm_side: Array | None) -> Array:
    """Rotation whose first axis is `along`; with a palm side the third is the flexion axis."""
    length = np.linalg.norm(along)
    if length == 0.0:
        return np.eye(3)
    x = along / length
    if palm_side is None:
        axis = np.cross([1.0, 0.0, 0.0], x)
        sine, cosine = float(np.linalg.norm(axis)), float(x[0])
        if sine < 1e-9:
            return np.eye(3) if cosine > 0 else np.diag([-1.0, -1.0, 1.0])
        k = axis / sine
        K = np.array([[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]])
        return np.eye(3) + sine * K + (1.0 - cosine) * K @ K
    y = palm_side - (palm_side @ x) * x
    y = -y / max(float(np.linalg.norm(y)), 1e-12)
    return np.stack([x, y, np.cross(x, y)], axis=1)

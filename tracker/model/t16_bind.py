"""Where the bones of a T16 model are at rest: read from a motion, or else worked out from the model's other files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.model.hand_axes import HandChains, find_flexion_axis, unit
from tracker.model.skeleton import Array


def find_motion_beside(off_path: Path) -> Path | None:
    """A MOTION file of this model: in its own folder or in `../seq/*/`."""
    stem = off_path.stem
    for pattern in (f"{stem}.MOTION*", f"../seq/*/{stem}.MOTION*"):
        for found in sorted(off_path.parent.glob(pattern)):
            if found.suffix in (".MOTION", ".gz") and found.is_file():
                return found
    return None


def estimate_joints(vertices: Array, weights: Array, parents: npt.NDArray[np.int64], lengths: Array) -> Array:
    """Joints (B, 3) of the bones from the mesh and its weights alone.

    A joint is where the weights of a bone and its parent overlap; two joints in a row are then moved along the bone
    between them until the length in the .SKEL file fits. A bone that branches off the root, whose weights say
    little, gets its joint on the line from its child's to the root's.

    Args:
        vertices: (V, 3).
        weights: (V, B).
        parents: (B,).
        lengths: (B,) from a bone's joint to that of its child.
    """
    joints = np.array([_overlap(vertices, weights, bone, int(parent)) for bone, parent in enumerate(parents)])
    root = int(np.flatnonzero(parents < 0)[0])
    is_branching = np.sum(parents == root) > 1
    for bone, parent in enumerate(parents):
        children = np.flatnonzero(parents == bone)
        if parent < 0 or len(children) != 1:
            continue
        child = int(children[0])
        if parent == root and is_branching:
            joints[bone] = joints[child] + lengths[bone] * unit(joints[root] - joints[child])
            continue
        along = joints[child] - joints[bone]
        excess = 0.5 * (np.linalg.norm(along) - lengths[bone]) * unit(along)
        joints[bone] = joints[bone] + excess
        joints[child] = joints[child] - excess
    return joints


def estimate_frames(joints: Array, ends: Array) -> Array:
    """Rest poses (B, 4, 4) with the first axis from the joint of a bone (B, 3) to its end (B, 3), least turned."""
    Ts = np.tile(np.eye(4), (len(joints), 1, 1))
    Ts[:, :3, 3] = joints
    for bone, along in enumerate(ends - joints):
        Ts[bone, :3, :3] = _least_turn(unit(along))
    return Ts


def turn_to_flexion(
    Ts: Array, chains: HandChains, finger_bones: dict[str, tuple[int, ...]], flexion_axes: dict[int, Array]
) -> Array:
    """Rest poses (B, 4, 4) of a hand, each finger bone rolled so that its axis 2 in .LIMITS is a flexion axis.

    T16's files bend a finger by negative angles, so their axis runs against that of `hand_axes`.

    Args:
        Ts: (B, 4, 4), first axes along the bones.
        chains: The joints of the hand.
        finger_bones: Bones of each finger.
        flexion_axes: (3,) axis 2 of each bone, bone frame.
    """
    Ts = Ts.copy()
    for finger, bones in finger_bones.items():
        lateral = find_flexion_axis(chains, finger)
        for bone in bones:
            x = Ts[bone, :3, 0]
            bend = -unit(lateral - (lateral @ x) * x)
            own_x = np.array([1.0, 0.0, 0.0])
            own = unit(flexion_axes[bone] * [0.0, 1.0, 1.0])
            world = np.stack([x, bend, np.cross(x, bend)], axis=1)
            local = np.stack([own_x, own, np.cross(own_x, own)], axis=1)
            Ts[bone, :3, :3] = world @ local.T
    return Ts


def _overlap(vertices: Array, weights: Array, bone: int, parent: int) -> Array:
    shared = weights[:, bone] if parent < 0 else weights[:, bone] * weights[:, parent]
    if shared.sum() < 1e-6:
        shared = weights[:, bone]
    total = shared.sum()
    return (shared @ vertices) / total if total > 0 else vertices.mean(axis=0)


def _least_turn(x: Array) -> Array:
    """The smallest rotation that brings the first axis to x."""
    axis = np.cross([1.0, 0.0, 0.0], x)
    sine, cosine = float(np.linalg.norm(axis)), float(x[0])
    if sine < 1e-9:
        return np.diag([-1.0, -1.0, 1.0]) if cosine < 0 else np.eye(3)
    k = axis / sine
    K = np.array([[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]])
    return np.eye(3) + sine * K + (1.0 - cosine) * K @ K

"""The skeleton of a hand from its joints: a wrist, and the bones of each finger."""

from __future__ import annotations

import numpy as np

from tracker.model.hand_axes import HandChains, HandJoint
from tracker.model.joints import FINGERS
from tracker.model.skeleton import Skeleton


def hand_bone_names(chains: HandChains) -> tuple[str, ...]:
    """ "wrist", then "<finger>_<segment>", thumb to little finger, palm first; 20 when every metacarpal is there."""
    return ("wrist", *(f"{finger}_{segment}" for finger in FINGERS for segment in chains.segments(finger)))


def build_hand_skeleton(chains: HandChains, joints: tuple[HandJoint, ...]) -> Skeleton:
    """Bones with the frame x along the bone, z out of the back of the finger; the revolute joints as given."""
    names = hand_bone_names(chains)
    parents = np.full(len(names), -1, dtype=np.int64)
    Ts = np.tile(np.eye(4), (len(names), 1, 1))
    Ts[0, :3, :3] = _frame(chains.forward, chains.dorsal)
    Ts[0, :3, 3] = chains.wrist
    for finger in FINGERS:
        points = chains.fingers[finger]
        segments = chains.segments(finger)
        backs = [joint.axis for joint in joints if joint.finger == finger and joint.motion == "flexion"]
        for number, segment in enumerate(segments):
            bone = names.index(f"{finger}_{segment}")
            parents[bone] = 0 if number == 0 else bone - 1
            along = points[number + 1] - points[number]
            Ts[bone, :3, :3] = _frame(along, np.cross(along, backs[-1]))
            Ts[bone, :3, 3] = points[number]
    return Skeleton(
        bone_names=names,
        parents=parents,
        Ts_model_bone=Ts,
        dof_bones=np.array([names.index(f"{joint.finger}_{joint.segment}") for joint in joints], dtype=np.int64),
        dof_axes=np.array([joint.axis for joint in joints]),
        lower=np.array([joint.lower for joint in joints]),
        upper=np.array([joint.upper for joint in joints]),
    )


def _frame(along: np.ndarray, back: np.ndarray) -> np.ndarray:
    x = along / np.linalg.norm(along)
    z = back - (back @ x) * x
    z = z / np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z], axis=1)

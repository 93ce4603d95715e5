"""A track's hands in the parameters that programs around MANO read, [R17] Eq. 2-4."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.errors import TrackingError
from tracker.export.bone_motions import find_bone_motions
from tracker.model.articulated import ArticulatedModel, HandParts
from tracker.model.joints import HAND_JOINTS
from tracker.tracking.track import Track

Array = npt.NDArray[np.float64]

MANO_JOINTS: tuple[str, ...] = (
    *(f"{finger}_{joint}" for finger in ("index", "middle", "little", "ring") for joint in ("mcp", "pip", "dip")),
    *("thumb_cmc", "thumb_mcp", "thumb_ip"),
)
"""The 15 joints of `hand_pose` in MANO's order, behind its wrist; each finger's first one hangs on the wrist."""

NOTE = (
    "MANO-style parameters of Handloom's own hand, not a fit of MANO. Comparable: joint order, axes, rotation "
    "vectors, the kinematics (global_orient turns about the wrist, each joint's rotation is relative to its parent, "
    "*_joints_rest are the rest positions, wrist at 0). Not comparable: rest pose and shape. hand_pose is relative to "
    "this hand's rest pose, which is not MANO's mean and not exactly its flat hand (flat_hand_mean=True, without PCA, "
    "is the nearest); betas are zeros and say nothing about the person; the template is another. The metacarpals of "
    "this hand can move and MANO's cannot: what they turn is part of the finger's first joint, what they shift is "
    "lost. *_transl is the wrist in the recording's world, m: for smplx subtract MANO's wrist at rest, J(betas)[0]. "
    "In frames whose status is 'lost' the values repeat the last pose before."
)


def find_mano_parameters(track: Track) -> dict[str, np.ndarray]:
    """The arrays of a file; `right_` or `left_` stands before those of a hand.

    frame (T,), status (T,), joint_names (16,), note, and per hand: global_orient (T, 3) rad, hand_pose (T, 45) rad,
    transl (T, 3) the wrist, world, m, betas (10,) zeros, joints_rest (16, 3) m in MANO's axes, wrist at 0.

    Raises:
        TrackingError: There is no hand, or one whose joints are no bones.
    """
    hands = [
        (n, name, m) for n, (name, m) in enumerate(zip(track.setup.names, track.setup.models, strict=True)) if m.hand
    ]
    if not hands:
        followed = ", ".join(track.setup.names)
        raise TrackingError(f"The track follows {followed} and no hand; MANO parameters are those of hands.")
    motions = find_bone_motions(track)
    arrays = {
        "frame": track.frame,
        "status": track.status,
        "joint_names": np.array(("wrist", *MANO_JOINTS), dtype=np.str_),
        "note": np.array(NOTE, dtype=np.str_),
    }
    for index, name, model in hands:
        own = _find_hand(name, model, motions[:, track.setup.scene.bone_slices[index]])
        arrays |= {f"{name}_{key}": values for key, values in own.items()}
    return arrays


def find_mano_axes(model: ArticulatedModel) -> Array:
    """(3, 3) rotation from MANO's axes to the model's.

    MANO's hands are those of somebody who stands with the arms spread and the palms down: the fingers of the right
    one point along -x, of the left one along +x, thumbs along +z, the back of the hand is +y.
    """
    assert model.hand is not None
    joints = model.skeleton.joints_rest[model.hand.joint_bones]
    wrist, index, middle, little = (
        joints[HAND_JOINTS.index(name)] for name in ("wrist", "index_mcp", "middle_mcp", "little_mcp")
    )
    sign = -1.0 if model.hand.side == "right" else 1.0
    x = sign * _unit(middle - wrist)
    y = _unit(np.cross(index - little, x).astype(np.float64))
    return np.stack([x, y, np.cross(x, y)], axis=1)


def _find_hand(name: str, model: ArticulatedModel, motions: Array) -> dict[str, np.ndarray]:
    """The arrays of one hand from the motions (T, B, 4, 4) of its bones."""
    assert model.hand is not None
    bones = _find_bones(name, model.hand)
    R_model_mano = find_mano_axes(model)
    Rs = motions[:, bones, :3, :3] @ R_model_mano  # MANO's axes at rest to world, wrist first
    parents = [0 if place % 3 == 0 else place for place in range(len(MANO_JOINTS))]
    local = Rs[:, parents].swapaxes(-1, -2) @ Rs[:, 1:]
    wrist = model.skeleton.joints_rest[bones[0]]
    frames = len(motions)
    return {
        "global_orient": Rotation.from_matrix(Rs[:, 0]).as_rotvec(),
        "hand_pose": Rotation.from_matrix(local.reshape(-1, 3, 3)).as_rotvec().reshape(frames, 45),
        "transl": motions[:, bones[0], :3, :3] @ wrist + motions[:, bones[0], :3, 3],
        "betas": np.zeros(10),
        "joints_rest": (model.skeleton.joints_rest[bones] - wrist) @ R_model_mano,
    }


def _find_bones(name: str, hand: HandParts) -> list[int]:
    bones = [int(hand.joint_bones[HAND_JOINTS.index(joint)]) for joint in ("wrist", *MANO_JOINTS)]
    missing = [joint for joint, bone in zip(("wrist", *MANO_JOINTS), bones, strict=True) if bone < 0]
    if missing:
        raise TrackingError(f"The {name} hand's model has no bone for {', '.join(missing)}; MANO parameters need it.")
    return bones


def _unit(vector: Array) -> Array:
    return vector / np.linalg.norm(vector)

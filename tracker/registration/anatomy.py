"""How fingers bend: a prior over poses for any hand in MANO's order of joints, from where its joints are at rest."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.model.blend_model import BlendModel
from tracker.model.hand_axes import HandChains, derive_hand_joints
from tracker.registration.pose_prior import PosePrior

Array = npt.NDArray[np.float64]

SEGMENTS = {"thumb": ("metacarpal", "proximal", "distal")}
FINGER_SEGMENTS = ("proximal", "middle", "distal")
TIP_ORDER = ("thumb", "index", "middle", "ring", "little")

DEVIATIONS_DEG = {"flexion": 35.0, "abduction": 9.0, "twist": 4.0}
THUMB_DEVIATIONS_DEG = {"flexion": 25.0, "abduction": 18.0, "twist": 10.0}
MEAN_FLEXION_DEG = {"proximal": 22.0, "middle": 28.0, "distal": 14.0}
"""A relaxed hand; of the thumb the rest pose is the mean."""


def find_finger_bones(model: BlendModel) -> dict[str, list[int]]:
    """Bones of each finger from the palm out, by the joints' names (`index1`)."""
    names = list(model.joint_names)
    return {finger: [names.index(f"{finger}{number}") for number in (1, 2, 3)] for finger in TIP_ORDER}


def find_joint_axes(model: BlendModel) -> tuple[Array, dict[tuple[int, str], tuple[float, float]]]:
    """Axes (K, 3, 3) of flexion, abduction and twist in rows, and limits, rad from rest, by bone and motion."""
    rest = model.joints_of(model.template)
    bones = find_finger_bones(model)
    fingers = {
        finger: np.concatenate([rest[chain], model.template[model.tips[TIP_ORDER.index(finger)]][None]])
        for finger, chain in bones.items()
    }
    chains = HandChains(model.side, rest[0], fingers)
    axes = np.tile(np.eye(3), (len(model.parents) - 1, 1, 1))
    limits: dict[tuple[int, str], tuple[float, float]] = {}
    flexions = {}
    for joint in derive_hand_joints(chains):
        bone = bones[joint.finger][SEGMENTS.get(joint.finger, FINGER_SEGMENTS).index(joint.segment)]
        limits[bone, joint.motion] = (joint.lower, joint.upper)
        if joint.motion == "flexion":
            flexions[bone] = joint.axis
    for finger, chain in bones.items():
        for number, bone in enumerate(chain):
            along = fingers[finger][number + 1] - fingers[finger][number]
            along = along / np.linalg.norm(along)
            axes[bone - 1] = np.stack([flexions[bone], np.cross(along, flexions[bone]), along])
    return axes, limits


def make_anatomical_prior(model: BlendModel) -> PosePrior:
    """Wide in flexion, narrow in abduction, narrower in twist; with limits of flexion and of what has one."""
    axes, limits = find_joint_axes(model)
    K = len(axes)
    mean, root = np.zeros(3 * K), np.zeros((3 * K, 3 * K))
    rows, low, high = [], [], []
    for finger, chain in find_finger_bones(model).items():
        for segment, bone in zip(SEGMENTS.get(finger, FINGER_SEGMENTS), chain, strict=True):
            place = slice(3 * (bone - 1), 3 * bone)
            deviations = THUMB_DEVIATIONS_DEG if finger == "thumb" else DEVIATIONS_DEG
            for number, motion in enumerate(("flexion", "abduction", "twist")):
                is_hinge = motion == "abduction" and segment in ("middle", "distal")
                deviation = 4.0 if is_hinge else deviations[motion]
                root[3 * (bone - 1) + number, place] = axes[bone - 1, number] / np.radians(deviation)
                if (bone, motion) in limits and motion == "flexion":
                    row = np.zeros(3 * K)
                    row[place] = axes[bone - 1, number]
                    rows.append(row)
                    low.append(limits[bone, motion][0])
                    high.append(limits[bone, motion][1])
            if finger != "thumb":
                mean[place] = np.radians(MEAN_FLEXION_DEG[segment]) * axes[bone - 1, 0]
    return PosePrior(mean, root, np.array(rows), np.array(low), np.array(high))

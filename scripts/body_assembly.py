"""Weights, joints and hand blend shapes of the body, put together with the trained hand's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
from body_bones import BodyRig
from body_shape_space import ShapeSpace
from body_surface import MIRROR_X, R_BODY_HAND, BodySurface
from scipy import sparse
from untrained_skin import fit_joint_regressor

from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel
from tracker.model.decimation import limit_weights
from tracker.model.mano_files import BODY_JOINTS, SMPLH_JOINTS

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

REGRESSOR_RING = 400
"""Vertices around a joint of the body that its regressor may use."""
WRIST_FROM, WRIST_TO = -0.040, 0.015
"""Along the hand's x axis from the wrist, where the skin goes over from forearm to hand, m."""

SWAPPED = np.array(
    [
        SMPLH_JOINTS.index(name.replace("left", "right") if name.startswith("left") else name.replace("right", "left"))
        for name in SMPLH_JOINTS
    ]
)
"""The joint of the other side, for each joint."""


def assemble(rig: BodyRig, surface: BodySurface, space: ShapeSpace, provenance: dict[str, str]) -> BlendModel:
    """The body whose coefficients are those of the shape space."""
    hand = turned_hand(surface.hand)
    template = surface.mirrored(space.mean)
    directions = surface.mirrored(space.directions, MIRROR_X[:, None])
    right, left = (SMPLH_JOINTS.index(f"{side}_index1") for side in ("right", "left"))
    count = hand.num_bones - 1
    pose_mean = np.zeros((len(SMPLH_JOINTS) - 1, 3))
    components = np.zeros((2 * len(hand.pose_components), len(SMPLH_JOINTS) - 1, 3))
    blended = np.zeros((len(template), 3, len(SMPLH_JOINTS) - 1, 9))
    carry = surface.band[:, surface.num_half :]  # what the hand's end does the band takes up without a crease
    bands, hands = (surface.lefts[surface.right_band], surface.right_band), (surface.left_hand, surface.right_hand)
    for number, (first, own) in enumerate(((left, mirror_blend(hand, MIRROR_X)), (right, hand))):
        bones = slice(first - 1, first - 1 + count)
        pose_mean[bones] = own.pose_mean.reshape(-1, 3)
        rows = slice(number * len(own.pose_components), (number + 1) * len(own.pose_components))
        components[rows, bones] = own.pose_components.reshape(-1, count, 3)
        directions_own = own.pose_directions.reshape(-1, 3, count, 9)
        blended[hands[number], :, bones] = directions_own
        blended[bands[number], :, bones] = np.einsum("nh,hxkf->nxkf", carry, directions_own)
    parents = np.array([*rig.parents, *(-1,) * (2 * count)])
    for side, first in (("left", left), ("right", right)):
        above = hand.parents[1:]
        wrist = BODY_JOINTS.index(f"{side}_wrist")
        parents[first : first + count] = np.where(above == 0, wrist, first + above - 1)
    return BlendModel(
        name="body with hands",
        side="body",
        template=template,
        faces=surface.faces,
        shape_directions=directions,
        pose_directions=blended.reshape(len(template), 3, -1),
        skinning_weights=build_weights(rig, surface, space),
        joint_regressor=build_regressor(surface, space, template, directions),
        parents=parents,
        joint_names=SMPLH_JOINTS,
        pose_mean=pose_mean.ravel(),
        pose_components=components.reshape(len(components), -1),
        tips=np.concatenate([surface.right_hand[hand.tips], surface.left_hand[hand.tips]]),
        provenance=provenance,
    )


def turned_hand(hand: BlendModel) -> BlendModel:
    """The right hand in the axes of the T-pose."""
    R, bones = R_BODY_HAND, hand.num_bones - 1
    elements = np.kron(R, R)  # of vec(R Q R^T), row by row
    turned = np.einsum("xy,vykn,mn->vxkm", R, hand.pose_directions.reshape(-1, 3, bones, 9), elements)
    return replace(
        hand,
        template=hand.template @ R.T,
        shape_directions=np.einsum("xy,vys->vxs", R, hand.shape_directions),
        pose_directions=turned.reshape(len(hand.template), 3, -1),
        pose_mean=(hand.pose_mean.reshape(-1, 3) @ R.T).ravel(),
        pose_components=(hand.pose_components.reshape(-1, bones, 3) @ R.T).reshape(-1, 3 * bones),
    )


def build_weights(rig: BodyRig, surface: BodySurface, space: ShapeSpace) -> Array:
    """(V, 52), rows summing to one."""
    elbow, wrist = (BODY_JOINTS.index(f"right_{part}") for part in ("elbow", "wrist"))
    right = np.zeros((len(space.mean), len(SMPLH_JOINTS)))
    half = np.asarray(surface.rows @ rig.weights)
    half[:, elbow] += half[:, wrist]  # the band is where the wrist turns
    half[:, wrist] = 0.0
    right[: surface.num_half, : len(BODY_JOINTS)] = half / half.sum(axis=1, keepdims=True)
    middle = np.flatnonzero(surface.midline)
    right[middle] = 0.5 * (right[middle] + right[middle][:, SWAPPED])
    seam = np.concatenate([surface.right_band, surface.right_hand])
    along = -(space.mean[seam, 0] - _wrist(surface, space)[0])
    share = smoothstep((along - WRIST_FROM) / (WRIST_TO - WRIST_FROM))
    own = np.zeros((len(seam), surface.hand.num_bones))
    own[: len(surface.right_band), 0] = 1.0
    own[len(surface.right_band) :] = surface.hand.skinning_weights
    first = SMPLH_JOINTS.index("right_index1")
    right[seam, elbow] = (1.0 - share) * own[:, 0]
    right[seam, wrist] = share * own[:, 0]
    right[seam, first : first + own.shape[1] - 1] = own[:, 1:]
    right[: surface.num_half] = limit_weights(right[: surface.num_half])
    both = np.zeros((surface.lefts.max() + 1, len(SMPLH_JOINTS)))
    both[surface.lefts] = right[:, SWAPPED]
    both[: len(right)] = right
    return both / both.sum(axis=1, keepdims=True)


def build_regressor(surface: BodySurface, space: ShapeSpace, template: Array, directions: Array) -> sparse.csr_array:
    """(52, V): the body's joints fitted to people, wrists and fingers by the trained hand's."""
    rights = [n for n, name in enumerate(BODY_JOINTS) if not name.startswith("left") and not name.endswith("wrist")]
    fitted = fit_joint_regressor(
        template, space.joints[rights], directions, space.joint_directions[rights], REGRESSOR_RING
    ).toarray()
    other = np.zeros(len(template), dtype=np.int64)
    other[: len(surface.lefts)], other[surface.lefts] = surface.lefts, np.arange(len(surface.lefts))
    matrix = np.zeros((len(SMPLH_JOINTS), len(template)))
    for joint, row in zip(rights, fitted, strict=True):
        matrix[joint] = row
        matrix[SWAPPED[joint]] = 0.5 * (row + row[other]) if SWAPPED[joint] == joint else row[other]
    own = surface.hand.joint_regressor.toarray()
    for side, ids in (("right", surface.right_hand), ("left", surface.left_hand)):
        first = SMPLH_JOINTS.index(f"{side}_index1")
        joints = [SMPLH_JOINTS.index(f"{side}_wrist"), *range(first, first + len(own) - 1)]
        matrix[np.ix_(joints, ids)] = own
    return sparse.csr_array(matrix)


def smoothstep(share: Array) -> Array:
    """0 below 0, 1 above 1, level at both ends."""
    clipped = np.clip(share, 0.0, 1.0)
    return clipped**3 * (10.0 + clipped * (6.0 * clipped - 15.0))


def _wrist(surface: BodySurface, space: ShapeSpace) -> Array:
    return np.asarray(surface.hand.joint_regressor @ space.mean[surface.right_hand])[0]

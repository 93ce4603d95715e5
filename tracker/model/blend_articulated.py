"""A blend model as the tracker moves hands: with revolute joints about anatomical axes and a closed surface."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import ArticulatedModel, ShapeBasis
from tracker.model.blend_landmarks import find_landmark_offsets
from tracker.model.blend_limits import CHAINS, blend_chains
from tracker.model.blend_model import BlendModel
from tracker.model.decimation import limit_weights
from tracker.model.hand_axes import derive_hand_joints
from tracker.model.hand_parts import find_hand_parts
from tracker.model.hand_skeleton import build_hand_skeleton, hand_bone_names
from tracker.model.joints import FINGERS
from tracker.model.pose_blend import PoseBlend

Array = npt.NDArray[np.float64]

SIZE = 0.06
"""Standard deviation of a hand's size among adults, relative."""
BOUND = 4.0
"""Of a shape coefficient, standard deviations."""


def articulated_of(model: BlendModel) -> ArticulatedModel:
    """The hand that the tracker follows, at its mean shape.

    Its 16 bones and its skin are the blend model's; each bone turns about the axes that a hand's can (`hand_axes`), not
    as a ball. The shape basis is "size" and the model's own shape directions. The boundary at the wrist is closed with
    a vertex in its middle, so that the hand has an inside. A vertex follows its four heaviest bones. Its landmarks are
    where people see joints (`blend_landmarks`), which is not where it turns.

    Args:
        model: A hand of MANO's 16 joints.
    """
    assert model.side in ("right", "left")
    chains = blend_chains(model, np.zeros(model.num_shape))
    names = hand_bone_names(chains)
    bones = np.zeros(model.num_bones, dtype=np.int64)  # place of each of MANO's joints among the bones
    for finger, first in CHAINS.items():
        bones[first : first + 3] = [names.index(f"{finger}_{segment}") for segment in chains.segments(finger)]
    template, faces, closing = close_wrist(model.template, model.faces)
    grow = _Growth(closing, len(model.template))
    skeleton = build_hand_skeleton(chains, derive_hand_joints(chains))
    order = np.argsort(bones)
    weights = limit_weights(grow.rows(model.skinning_weights)[:, order])
    directions = grow.rows(model.shape_directions)
    regressor: Array = model.joint_regressor.toarray()[order]
    joint_directions = np.einsum("bv,vxs->sbx", regressor, model.shape_directions)
    joints = skeleton.joints_rest
    wrist = joints[0]
    shape = ShapeBasis(
        names=_shape_names(model),
        vertices=np.concatenate([SIZE * (template - wrist)[None], directions.transpose(2, 0, 1)]),
        joints=np.concatenate([SIZE * (joints - wrist)[None], joint_directions]),
        lower=np.full(1 + model.num_shape, -BOUND),
        upper=np.full(1 + model.num_shape, BOUND),
    )
    finger_bones = {
        finger: tuple(int(bone) for bone in bones[CHAINS[finger] : CHAINS[finger] + 3]) for finger in FINGERS
    }
    return ArticulatedModel(
        name=model.name,
        vertices=template,
        faces=faces,
        skinning_weights=weights,
        skeleton=skeleton,
        hand=replace(
            find_hand_parts(model.side, template, weights, joints, 0, finger_bones, model.tips),
            joint_offsets=find_landmark_offsets(template, faces, chains),
        ),
        shape=shape,
        provenance=dict(model.provenance),
        pose_blend=PoseBlend(bones[1:], grow.rows(model.pose_directions)) if np.any(model.pose_directions) else None,
    )


def close_wrist(
    vertices: Array, faces: npt.NDArray[np.int64]
) -> tuple[Array, npt.NDArray[np.int64], list[npt.NDArray[np.int64]]]:
    """Every hole closed by a fan of faces about a new vertex in the middle of its edge.

    Returns:
        vertices: The new ones behind the others.
        faces: The new ones behind the others, looking outwards as those beside them.
        loops: For each new vertex those that it is the mean of.
    """
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    present = {(int(a), int(b)) for a, b in edges}
    following = {a: b for a, b in present if (b, a) not in present}
    loops, fans = [], []
    while following:
        loop = [next(iter(following))]
        while (after := following.pop(loop[-1], loop[0])) != loop[0]:
            loop.append(after)
        middle = len(vertices) + len(loops)
        fans += [(b, a, middle) for a, b in zip(loop, [*loop[1:], loop[0]], strict=True)]
        loops.append(np.array(loop))
    middles = [vertices[loop].mean(axis=0) for loop in loops]
    return (
        np.concatenate([vertices, np.array(middles).reshape(-1, 3)]),
        np.concatenate([faces, np.array(fans, dtype=np.int64).reshape(-1, 3)]),
        loops,
    )


class _Growth:
    """Gives new vertices what the mean of others has."""

    def __init__(self, loops: list[npt.NDArray[np.int64]], count: int) -> None:
        self.loops, self.count = loops, count

    def rows(self, values: Array) -> Array:
        assert len(values) == self.count
        return np.concatenate([values, *(values[loop].mean(axis=0)[None] for loop in self.loops)])


def _shape_names(model: BlendModel) -> tuple[str, ...]:
    """ "size", then what the model's maker called its directions, or their numbers."""
    told = [name.strip().replace(" ", "_") for name in model.provenance.get("shape_names", "").split(",")]
    if len(told) != model.num_shape or len(set(told)) != len(told):
        told = [f"shape_{number + 1}" for number in range(model.num_shape)]
    return ("size", *("own_size" if name == "size" else name for name in told))

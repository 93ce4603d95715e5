"""The other hand: a model reflected, with joint angles that keep their meaning."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.pose_blend import PoseBlend
from tracker.model.skeleton import Array

MIRROR = np.array([1.0, -1.0, 1.0])
"""The reflection y -> -y of the model frame."""

OTHER_SIDE = {"right": "left", "left": "right"}


def mirror(model: ArticulatedModel) -> ArticulatedModel:
    """The model reflected in the plane y = 0 of its frame; mirroring twice gives the model back.

    Faces are turned to look outwards again. Axes of rotation are axial vectors, so a joint's angle and limits stay:
    at the pose `mirror_pose` of a pose, the mirrored model is the mirror image of the model.
    """
    skeleton = model.skeleton
    Ts = skeleton.Ts_model_bone * np.outer([*MIRROR, 1.0], [*MIRROR, 1.0])
    hand, shape = model.hand, model.shape
    words = {"right": "left", "left": "right", "Right": "Left", "Left": "Right"}
    return replace(
        model,
        name=" ".join(words.get(word, word) for word in model.name.split(" ")),
        vertices=model.vertices * MIRROR,
        faces=np.ascontiguousarray(model.faces[:, ::-1]),
        skeleton=replace(skeleton, Ts_model_bone=Ts, dof_axes=-skeleton.dof_axes * MIRROR),
        hand=None
        if hand is None
        else replace(hand, side=OTHER_SIDE[hand.side], joint_offsets=hand.joint_offsets * MIRROR + 0.0),
        shape=None if shape is None else replace(shape, vertices=shape.vertices * MIRROR, joints=shape.joints * MIRROR),
        pose_blend=None if model.pose_blend is None else _mirror_blend(model.pose_blend),
        provenance={**model.provenance, "mirrored": "no" if model.provenance.get("mirrored") == "yes" else "yes"},
    )


def _mirror_blend(blend: PoseBlend) -> PoseBlend:
    elements = np.tile(np.outer(MIRROR, MIRROR).ravel(), len(blend.bones))
    return replace(blend, directions=blend.directions * MIRROR[:, None] * elements)


def mirror_pose(pose: Array) -> Array:
    """The pose (D,) of the mirrored model that shows the mirror image, in the plane y = 0 of the world."""
    T = se3.exp(np.ascontiguousarray(pose[:6]))
    reflection = np.array([*MIRROR, 1.0])
    return np.concatenate([se3.log(T * np.outer(reflection, reflection)), pose[6:]])

"""The other hand: a model reflected, with joint angles that keep their meaning."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.model.articulated import ArticulatedModel
from tracker.model.skeleton import Array

MIRROR = np.array([1.0, -1.0, 1.0])
"""The reflection y -> -y of the model frame."""

OTHER_SIDE = {"right": "left", "left": "right"}


def mirror(model: ArticulatedModel) -> ArticulatedModel:
    """The model reflected in the plane y = 0 of its frame; mirroring twice gives the model back.

    Faces are turned to look outwards again. Axes of rotation are axial vectors, so a joint's angle and limits stay:
    with the root's motion reflected too, the mirrored model is the mirror image of the model.
    """
    skeleton = model.skeleton
    Ts = skeleton.Ts_model_bone * np.outer([*MIRROR, 1.0], [*MIRROR, 1.0])
    hand, shape = model.hand, model.shape
    return replace(
        model,
        name=mirror_name(model.name),
        vertices=model.vertices * MIRROR,
        faces=np.ascontiguousarray(model.faces[:, ::-1]),
        skeleton=replace(skeleton, Ts_model_bone=Ts, dof_axes=-skeleton.dof_axes * MIRROR),
        hand=None
        if hand is None
        else replace(hand, side=OTHER_SIDE[hand.side], joint_offsets=hand.joint_offsets * MIRROR + 0.0),
        shape=None if shape is None else replace(shape, vertices=shape.vertices * MIRROR, joints=shape.joints * MIRROR),
        pose_blend=None
        if model.pose_blend is None
        else replace(model.pose_blend, directions=mirror_pose_directions(model.pose_blend.directions, MIRROR)),
        provenance=mirror_provenance(model.provenance),
    )


def mirror_pose_directions(directions: Array, reflection: Array) -> Array:
    """Pose blend shapes (V, 3, 9K) of a model reflected by (3,) factors of its axes."""
    elements = np.tile(np.outer(reflection, reflection).ravel(), directions.shape[2] // 9)
    return directions * reflection[:, None] * elements


def mirror_name(name: str) -> str:
    """The name with left and right exchanged."""
    words = {"right": "left", "left": "right", "Right": "Left", "Left": "Right"}
    return " ".join(words.get(word, word) for word in name.split(" "))


def mirror_provenance(provenance: dict[str, str]) -> dict[str, str]:
    """The provenance of the other hand."""
    return {**provenance, "mirrored": "no" if provenance.get("mirrored") == "yes" else "yes"}

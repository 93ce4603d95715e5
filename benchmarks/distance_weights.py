"""The crudest hand that a trained one can be compared with: blend weights by distance, size alone to fit.

The bars of `benchmarks/results/model_training.md` come from a prototype with such an untrained hand. Ours has weights
that people drew, which is a better hand to begin with and a harder one to compare with; both are measured.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.model.blend_model import BLEND_PARENTS, BlendModel

Array = npt.NDArray[np.float64]

FALLOFF = 4.0
"""A bone's weight is its distance to this power, inverted."""
MOST_BONES = 4
LEAST_WEIGHT = 0.01


def with_distance_weights(model: BlendModel) -> BlendModel:
    """The model with blend weights by distance, among the nearest bone and those that it hangs together with."""
    vertices, joints = model.template, np.asarray(model.joint_regressor @ model.template)
    bones = len(joints)
    distances = np.full((len(vertices), bones), np.inf)
    for bone, start, end in _bone_segments(joints, vertices[model.tips]):
        distances[:, bone] = np.minimum(distances[:, bone], _distance(vertices, start, end))
    linked = np.eye(bones, dtype=bool)
    for bone, parent in enumerate(BLEND_PARENTS):
        if parent >= 0:
            linked[bone, parent] = linked[parent, bone] = True
    weights = np.where(linked[distances.argmin(axis=1)], distances**-FALLOFF, 0.0)
    least = np.sort(weights, axis=1)[:, -MOST_BONES][:, None]
    weights = np.where(weights >= least, weights, 0.0)
    weights /= weights.sum(axis=1, keepdims=True)
    weights[weights < LEAST_WEIGHT] = 0.0
    return replace(model, skinning_weights=weights / weights.sum(axis=1, keepdims=True))


def _bone_segments(joints: Array, tips: Array) -> list[tuple[int, Array, Array]]:
    """Bone, start and end; the wrist's are the forearm and the lines to the knuckles, but not to the thumb's base."""
    segments = [(0, joints[0], joints[0] - 0.5 * (joints[4] - joints[0]))]
    for first, tip in ((1, 1), (4, 2), (7, 4), (10, 3), (13, 0)):
        chain = [*joints[first : first + 3], tips[tip]]
        if first != 13:
            segments.append((0, joints[0], joints[first]))
        segments += [(first + n, chain[n], chain[n + 1]) for n in range(3)]
    return segments


def _distance(points: Array, start: Array, end: Array) -> Array:
    along = end - start
    share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
    return np.maximum(np.linalg.norm(points - start - share[:, None] * along, axis=1), 1e-4)

"""Small models that tests can reason about."""

from __future__ import annotations

import numpy as np

from tracker.model.articulated import ArticulatedModel
from tracker.model.skeleton import Skeleton


def tube(
    bones: int = 3, rings: int = 13, sides: int = 10, radius: float = 0.008, length: float = 0.03
) -> ArticulatedModel:
    """A closed tube along +x with a root and `bones - 1` joints of two axes each, weights blended around the joints."""
    total = bones * length
    xs = np.linspace(0.0, total, rings)
    angles = np.linspace(0.0, 2 * np.pi, sides, endpoint=False)
    vertices = [[x, radius * np.cos(a), radius * np.sin(a)] for x in xs for a in angles]
    vertices += [[-radius, 0.0, 0.0], [total + radius, 0.0, 0.0]]
    faces = []
    for ring in range(rings - 1):
        for side in range(sides):
            a, b = ring * sides + side, ring * sides + (side + 1) % sides
            faces += [[a, b, a + sides], [b, b + sides, a + sides]]
    first, last = len(vertices) - 2, len(vertices) - 1
    for side in range(sides):
        faces.append([first, (side + 1) % sides, side])
        faces.append([last, (rings - 1) * sides + side, (rings - 1) * sides + (side + 1) % sides])
    points = np.array(vertices)
    centers = (np.arange(bones) + 0.5) * length
    weights = np.exp(-(((points[:, :1] - centers) / (0.4 * length)) ** 2)) + 1e-12
    weights[weights < 0.02 * weights.max(axis=1, keepdims=True)] = 0.0
    weights /= weights.sum(axis=1, keepdims=True)
    Ts = np.tile(np.eye(4), (bones, 1, 1))
    Ts[:, 0, 3] = np.arange(bones) * length
    dof_bones = np.repeat(np.arange(1, bones), 2)
    axes = np.tile([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]], (bones - 1, 1))
    skeleton = Skeleton(
        bone_names=tuple(f"bone_{i}" for i in range(bones)),
        parents=np.arange(bones) - 1,
        Ts_model_bone=Ts,
        dof_bones=dof_bones,
        dof_axes=axes,
        lower=np.full(len(dof_bones), -1.2),
        upper=np.full(len(dof_bones), 1.2),
    )
    return ArticulatedModel("tube", points, np.array(faces, dtype=np.int32), weights, skeleton)

"""A ball and fingers that hang around it: a small scene whose physics can be reasoned about."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import trimesh

from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel, HandParts
from tracker.model.scene import PosedScene, Scene
from tracker.model.skeleton import Skeleton

BALL_RADIUS = 0.02
FINGERS = ("thumb_distal", "index_distal", "middle_distal", "ring_distal", "little_distal")


def ball(radius: float = BALL_RADIUS) -> ArticulatedModel:
    """A rigid ball around the origin."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=radius)
    return rigid("ball", np.array(mesh.vertices), np.array(mesh.faces))


def cube(side: float = 0.04) -> ArticulatedModel:
    """A rigid cube around the origin."""
    mesh = trimesh.creation.box(extents=[side] * 3)
    return rigid("cube", np.array(mesh.vertices), np.array(mesh.faces))


def rigid(name: str, vertices: np.ndarray, faces: np.ndarray) -> ArticulatedModel:
    none = np.zeros(0)
    skeleton = Skeleton(
        (name,), np.array([-1]), np.eye(4)[None], np.zeros(0, dtype=np.int64), np.zeros((0, 3)), none, none
    )
    return ArticulatedModel(name, vertices, faces.astype(np.int64), np.ones((len(vertices), 1)), skeleton)


def gripper(directions: Sequence[Sequence[float]], gaps: Sequence[float], radius: float = BALL_RADIUS):
    """A hand of one tip for each direction, which looks at the origin from beyond `radius` and its gap, m.

    Each tip is a block of 12 mm on a finger that hangs 0.1 m above it (-y) and swings about two axes.
    """
    block = trimesh.creation.box(extents=[0.012] * 3)
    count = len(directions)
    vertices, faces, weights, parts = [], [], [], {}
    Ts = np.tile(np.eye(4), (count + 1, 1, 1))
    Ts[0, :3, 3] = [0.0, -0.3, 0.0]
    vertices.append(np.array(block.vertices) + Ts[0, :3, 3])
    faces.append(np.array(block.faces))
    weights.append(np.eye(count + 1)[np.zeros(8, dtype=int)])
    for number, (direction, gap) in enumerate(zip(directions, gaps, strict=True)):
        along = np.array(direction, dtype=np.float64) / np.linalg.norm(direction)
        z = along
        x = np.cross([0.0, 1.0, 0.0], z) if abs(z[1]) < 0.9 else np.array([1.0, 0.0, 0.0])
        x /= np.linalg.norm(x)
        R = np.stack([x, np.cross(z, x), z], axis=1)
        center = (radius + gap + 0.006) * along
        vertices.append(np.array(block.vertices) @ R.T + center)
        faces.append(np.array(block.faces) + 8 * (number + 1))
        weights.append(np.eye(count + 1)[np.full(8, number + 1)])
        Ts[number + 1, :3, 3] = center - np.array([0.0, 0.1, 0.0])
        parts[FINGERS[number]] = np.arange(8) + 8 * (number + 1)
    skeleton = Skeleton(
        ("wrist", *FINGERS[:count]),
        np.r_[-1, np.zeros(count, dtype=np.int64)],
        Ts,
        np.repeat(np.arange(1, count + 1), 2),
        np.tile([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], (count, 1)),
        np.full(2 * count, -1.0),
        np.full(2 * count, 1.0),
    )
    parts["wrist"] = np.arange(8)
    tips = tuple(parts.get(name, np.zeros(0, dtype=np.int64)) for name in FINGERS)
    hand = HandParts("right", np.zeros(21, dtype=np.int64), np.full(21, -1), tips, parts)
    return ArticulatedModel(
        "gripper", np.concatenate(vertices), np.concatenate(faces), np.concatenate(weights), skeleton, hand
    )


def gripped(
    directions: Sequence[Sequence[float]], gaps: Sequence[float], thing: ArticulatedModel | None = None
) -> PosedScene:
    """The gripper and a ball at rest, somewhere before a camera: hand 0, object 1; +y is down."""
    scene = Scene((gripper(directions, gaps), thing or ball()))
    pose = scene.rest_pose()
    for where in scene.pose_slices:
        pose[where.start : where.start + 6] = se3.log(se3.exp(np.array([0.05, -0.02, 0.5, 0.0, 0.0, 0.0])))
    return scene.pose_at(pose)


PINCH = ([1, 0, 0], [-1, 0, 0])
"""Two tips that face each other from the sides."""

"""How a hand differs in its parts: each bone's length, each knuckle's place, joints in the flesh, dents of the palm.

They are made from the joints and skinning weights of whatever hand is given. None of them comes from another person's
hand: the sizes below are round numbers for how far one adult's part is from another's when the whole is of equal size.
"""

from __future__ import annotations

import numpy as np

from tracker.model.articulated import ArticulatedModel
from tracker.model.hand_directions import HandDirections
from tracker.model.hand_parts import finger_segments
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.scene import Scene
from tracker.model.skeleton import Array

LENGTH = 0.06
"""Of a bone, relative."""
THICKNESS = 0.07
"""Of a finger at one bone, relative."""
KNUCKLE = 0.0025
"""Of where a finger leaves the palm, along each axis, m."""
THUMB_BASE = 0.004
"""Of where the thumb's first joint is, along each axis, m."""
IN_FLESH = 0.002
"""Of where a joint turns within the same flesh, along each axis, m."""
DENT = 0.002
"""Of the palm's surface at one place, m."""
DENT_WIDTH = 0.016
"""How far a dent reaches, m."""
DENTS = 28
"""Places on the palm."""
FOREARM = 0.3
"""Of the stump's length, relative."""
PALM_REACH = 0.020
"""How far the palm goes with a knuckle, m."""


def local_directions(model: ArticulatedModel) -> HandDirections:
    """All of them for a hand with its landmarks."""
    assert model.hand is not None
    maker = _Maker(model)
    parts = [*maker.bones(), *maker.roots(), *maker.joints_in_flesh(), *maker.dents(), maker.forearm()]
    names, vertices, joints = zip(*parts, strict=True)
    return HandDirections(tuple(names), np.array(vertices), np.array(joints), np.zeros((len(names), 21, 3)))


def mark_directions(model: ArticulatedModel, along: Array, across: Array) -> HandDirections:
    """Where annotators put the joints, other than where the model has them.

    Args:
        model: A hand.
        along: (21,) standard deviation along the bone that ends or begins at each joint, m.
        across: (21,) the same square to it.
    """
    assert model.hand is not None
    landmarks = Scene((model,)).pose_at(np.zeros(model.num_dofs)).landmarks(0)
    names, marks = [], []
    for joint, name in enumerate(HAND_JOINTS):
        if joint == 0:
            ahead = landmarks[HAND_JOINTS.index("middle_mcp")] - landmarks[0]
        elif (joint - 1) % 4 == 3:
            ahead = landmarks[joint] - landmarks[joint - 1]
        else:
            ahead = landmarks[joint + 1] - landmarks[joint]
        frame = np.linalg.svd(ahead[None] / np.linalg.norm(ahead))[2]
        for axis, deviation in zip(frame, (along[joint], across[joint], across[joint]), strict=True):
            names.append(f"mark_{name}_{len(names) % 3}")
            move = np.zeros((21, 3))
            move[joint] = deviation * axis
            marks.append(move)
    inner = [joint for joint in range(1, 21) if joint % 4]
    names.append("marks_farther_out")
    move = np.zeros((21, 3))
    for joint in inner:
        ahead = landmarks[joint + 1] - landmarks[joint]
        move[joint] = 0.003 * ahead / np.linalg.norm(ahead)
    marks.append(move)
    names.append("marks_dorsal")
    up = np.cross(landmarks[9] - landmarks[0], landmarks[5] - landmarks[17])
    move = np.zeros((21, 3))
    move[[0, *inner]] = 0.002 * up / np.linalg.norm(up)
    marks.append(move)
    count, skeleton = len(names), model.skeleton
    return HandDirections(
        tuple(names),
        np.zeros((count, len(model.vertices), 3)),
        np.zeros((count, skeleton.num_bones, 3)),
        np.array(marks),
    )


Part = tuple[str, Array, Array]


class _Maker:
    def __init__(self, model: ArticulatedModel) -> None:
        hand, skeleton = model.hand, model.skeleton
        assert hand is not None
        self.model, self.hand = model, hand
        landmarks = Scene((model,)).pose_at(np.zeros(model.num_dofs)).landmarks(0) - hand.joint_offsets
        self.wrist = landmarks[0]
        self.chains = {f: landmarks[1 + 4 * n : 5 + 4 * n] for n, f in enumerate(FINGERS)}
        self.bones_of = {f: [int(b) for b in hand.joint_bones[1 + 4 * n : 4 + 4 * n]] for n, f in enumerate(FINGERS)}
        # a joint sits at the palm's end of its bone, so it goes with the bone before
        follow = np.eye(skeleton.num_bones)[np.maximum(skeleton.parents, 0)]
        self.points = np.concatenate([model.vertices, skeleton.joints_rest])
        self.weights = np.concatenate([model.skinning_weights, follow])
        self.num_vertices = len(model.vertices)
        self.finger = {f: self.weights[:, self.bones_of[f]].sum(axis=1) for f in FINGERS}
        self.palm = np.clip(1.0 - sum(self.finger.values()), 0.0, 1.0)
        forward = self.chains["middle"][0] - self.wrist
        side = self.chains["index"][0] - self.chains["little"][0]
        up = np.cross(forward, side)
        forward, up = forward / np.linalg.norm(forward), up / np.linalg.norm(up)
        self.frame = np.stack([forward, np.cross(up, forward), up])

    def _part(self, name: str, offsets: Array) -> Part:
        return name, offsets[: self.num_vertices], offsets[self.num_vertices :]

    def bones(self) -> list[Part]:
        """Length and thickness at each bone of each finger."""
        parts = []
        for finger in FINGERS:
            chain = self.chains[finger]
            for number, segment in enumerate(finger_segments(finger)[-3:]):
                start, along = chain[number], chain[number + 1] - chain[number]
                share = (self.points - start) @ along / (along @ along)
                is_last = number == 2
                longer = np.clip(share, 0.0, None if is_last else 1.0)
                moved = self.finger[finger][:, None] * longer[:, None] * along
                parts.append(self._part(f"{finger}_{segment}_length", LENGTH * moved))
                radial = self.points - start - share[:, None] * along
                near = np.clip(np.minimum(share + 0.5, 1.5 - share if not is_last else 1.0), 0.0, 1.0)
                moved = (self.finger[finger] * near)[:, None] * radial
                moved[self.num_vertices :] = 0.0
                parts.append(self._part(f"{finger}_{segment}_thickness", THICKNESS * moved))
        return parts

    def roots(self) -> list[Part]:
        """Where each finger leaves the palm, which follows."""
        anchors = np.stack([self.chains[f][0] for f in FINGERS] + [self.wrist])
        away = np.linalg.norm(self.points[:, None] - anchors, axis=2) ** 2 / (2.0 * PALM_REACH**2)
        near = np.exp(-(away - away.min(axis=1, keepdims=True)))
        near = near / near.sum(axis=1, keepdims=True)
        parts = []
        for number, finger in enumerate(FINGERS):
            share = self.finger[finger] + self.palm * near[:, number]
            base = self.num_vertices + self.bones_of[finger][0]
            share[base] = 1.0
            deviation = THUMB_BASE if finger == "thumb" else KNUCKLE
            for axis, direction in enumerate(self.frame):
                parts.append(self._part(f"{finger}_root_{'xyz'[axis]}", deviation * share[:, None] * direction))
        return parts

    def joints_in_flesh(self) -> list[Part]:
        """Where a joint turns, the surface at rest staying."""
        parts = []
        for finger in FINGERS:
            for bone in self.bones_of[finger]:
                for axis, direction in enumerate(self.model.skeleton.Ts_model_bone[bone, :3, :3].T):
                    offsets = np.zeros_like(self.points)
                    deviation = 2.0 * IN_FLESH if bone == self.bones_of["thumb"][0] else IN_FLESH
                    offsets[self.num_vertices + bone] = deviation * direction
                    parts.append(self._part(f"{self.model.skeleton.bone_names[bone]}_turns_{'xyz'[axis]}", offsets))
        return parts

    def dents(self) -> list[Part]:
        """Smooth bumps and dents of palm and wrist."""
        normals = Scene((self.model,)).pose_at(np.zeros(self.model.num_dofs)).normals[: self.num_vertices]
        vertices = self.model.vertices
        candidates = np.flatnonzero(self.palm[: self.num_vertices] > 0.5)
        chosen = [int(candidates[np.argmax((vertices[candidates] - self.wrist) @ self.frame[2])])]
        for _ in range(DENTS - 1):
            away = np.linalg.norm(vertices[candidates, None] - vertices[chosen], axis=2).min(axis=1)
            chosen.append(int(candidates[np.argmax(away)]))
        parts = []
        for number, center in enumerate(chosen):
            near = np.exp(-np.sum((vertices - vertices[center]) ** 2, axis=1) / (2.0 * DENT_WIDTH**2))
            same_side = np.clip(normals @ normals[center], 0.0, 1.0)
            offsets = np.zeros_like(self.points)
            share = near * same_side * self.palm[: self.num_vertices]
            offsets[: self.num_vertices] = DENT * share[:, None] * normals
            parts.append(self._part(f"dent_{number}", offsets))
        return parts

    def forearm(self) -> Part:
        """How much of the forearm there is."""
        behind = np.minimum((self.points - self.wrist) @ self.frame[0], 0.0)
        offsets = FOREARM * behind[:, None] * self.frame[0]
        offsets[self.num_vertices :] = 0.0
        return self._part("forearm_length", offsets)

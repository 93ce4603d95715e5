"""The people whose hands are scanned."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from tracker.errors import TrackerError
from tracker.model.hand_axes import HandChains, HandJoint, derive_hand_joints
from tracker.model.hand_skeleton import hand_bone_names
from tracker.model.joints import FINGERS
from tracker.synthesis.scans.subdivision import subdivide

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


TRAIN_SUBJECTS = tuple(range(1, 32))
TEST_SUBJECTS = tuple(range(32, 38))
MEAN_SUBJECT = 0
"""The mean adult, who is not scanned: the untrained hand's vertices are tied to its surface."""

MAX_INFLUENCES = 8
"""Bones that a vertex follows."""


@dataclass(frozen=True)
class HandSurface:
    """What all subjects' meshes share.

    Attributes:
        faces: (F, 3) of the mesh that is deformed: the coarse one subdivided once.
        fine: (W, V) vertices of the surface that is scanned from those that are deformed.
        fine_faces: (4 F, 3).
        border: (L,) the open end of the forearm, vertices of the deformed mesh in order.
        bone_ids: (V, MAX_INFLUENCES) and weights (V, MAX_INFLUENCES) of its skinning.
        weights: See bone_ids.
        all_weights: (V, 20) the same, dense.
    """

    faces: Ints
    fine: csr_matrix
    fine_faces: Ints
    border: Ints
    bone_ids: Ints
    weights: Array
    all_weights: Array


@dataclass(frozen=True)
class Subject:
    """One right hand at rest; frame: origin at the wrist, x to the middle knuckle, z out of the back, m.

    Attributes:
        number: 1 to 37; 0 is the mean adult.
        vertices: (V, 3).
        chains: Its joints.
        joints: (20, 3) where each bone begins.
        ends: (20, 3) where each bone ends; the wrist's at the middle knuckle.
        dofs: 31 revolute joints.
        dof_bones: (31,) the bone that each turns.
        is_abduction: (31,).
        dof_axes: (31, 3).
    """

    number: int
    vertices: Array
    chains: HandChains
    joints: Array
    ends: Array
    dofs: tuple[HandJoint, ...]
    dof_bones: Ints
    is_abduction: npt.NDArray[np.bool_]
    dof_axes: Array


BONES = (
    "wrist",
    *(f"thumb_{segment}" for segment in ("metacarpal", "proximal", "distal")),
    *(f"{f}_{segment}" for f in FINGERS[1:] for segment in ("metacarpal", "proximal", "middle", "distal")),
)
PARENTS: Ints = np.array([-1, 0, 1, 2, *(p for k in range(4) for p in (0, 4 + 4 * k, 5 + 4 * k, 6 + 4 * k))])


@cache
def _arrays() -> dict[str, npt.NDArray]:
    with np.load(Path(__file__).parent / "data" / "subjects.npz") as data:
        return {name: data[name] for name in data.files}


@cache
def load_surface() -> HandSurface:
    """The mesh of all subjects."""
    arrays = _arrays()
    coarse = arrays["faces"].astype(np.int64)
    once = subdivide(coarse, len(arrays["weights"]))
    twice = subdivide(once.faces, once.size)
    weights = once.matrix @ (arrays["weights"] / arrays["weights"].sum(axis=1, keepdims=True))
    ids = np.argsort(-weights, axis=1, kind="stable")[:, :MAX_INFLUENCES]
    kept = np.take_along_axis(weights, ids, axis=1)
    kept /= kept.sum(axis=1, keepdims=True)
    dense = np.zeros_like(weights)
    np.put_along_axis(dense, ids, kept, axis=1)
    return HandSurface(
        once.faces, twice.matrix, twice.faces, find_border(once.faces), np.ascontiguousarray(ids), kept, dense
    )


def find_border(faces: Ints) -> Ints:
    """(L,) the vertices of the one open border of a mesh, such that a fan over it would close the mesh."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    known = {(int(a), int(b)) for a, b in edges}
    following = {b: a for a, b in known if (b, a) not in known}
    start = min(following)
    loop = [start]
    while following[loop[-1]] != start:
        loop.append(following[loop[-1]])
    assert len(loop) == len(following), "the hand must have one border"
    return np.array(loop, dtype=np.int64)


@lru_cache(maxsize=48)
def load_subject(number: int) -> Subject:
    """Subject `number`; see TRAIN_SUBJECTS and TEST_SUBJECTS.

    Raises:
        TrackerError: There is none.
    """
    arrays = _arrays()
    if not 0 <= number < len(arrays["vertices"]):
        raise TrackerError(f"There is no subject {number}; there are 1 to {len(arrays['vertices']) - 1}.")
    quantum = float(arrays["quantum"])
    coarse = arrays["vertices"][number] * quantum
    points = arrays["joints"][number] * quantum
    once = subdivide(arrays["faces"].astype(np.int64), len(coarse))
    chains = HandChains("right", points[0], {f: points[finger_rows(f)] for f in FINGERS})
    assert hand_bone_names(chains) == BONES
    joints, ends = [points[0]], [chains.fingers["middle"][1]]
    for finger in FINGERS:
        joints += list(chains.fingers[finger][:-1])
        ends += list(chains.fingers[finger][1:])
    dofs = derive_hand_joints(chains)
    return Subject(
        number,
        np.asarray(once.matrix @ coarse),
        chains,
        np.array(joints),
        np.array(ends),
        dofs,
        np.array([BONES.index(f"{dof.finger}_{dof.segment}") for dof in dofs], dtype=np.int64),
        np.array([dof.motion == "abduction" for dof in dofs]),
        np.array([dof.axis for dof in dofs]),
    )


def finger_rows(finger: str) -> slice:
    """Rows of a finger's joints, from the palm to its end, among the 25 points kept of a subject."""
    number = FINGERS.index(finger)
    return slice(1, 5) if number == 0 else slice(5 * number, 5 * number + 5)

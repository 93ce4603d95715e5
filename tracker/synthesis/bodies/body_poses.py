"""Poses that generated people stand in: limbs and trunk by chance, fingers as real people's were."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.body_hands import body_hand
from tracker.model.mano_files import BODY_JOINTS, SMPLH_JOINTS
from tracker.synthesis.bodies.hand_poses import MIRRORED, load_hand_poses
from tracker.synthesis.bodies.person import Person

Array = npt.NDArray[np.float64]

A_POSE_DEG = 50.0
"""How far the arms hang from the horizontal in the A-pose."""
MAX_DRAWS = 60
"""The last is taken even where limbs are in each other."""
MAX_INSIDE, DEPTH = 6, 4e-3
"""So many vertices of an arm may lie so far (m) inside the rest of the body."""

RANGES_DEG: dict[str, tuple[tuple[float, float], tuple[float, float], tuple[float, float]]] = {
    "spine1": ((-6, 12), (-8, 8), (-6, 6)),
    "spine2": ((-6, 12), (-8, 8), (-6, 6)),
    "spine3": ((-4, 8), (-6, 6), (-5, 5)),
    "neck": ((-10, 15), (-25, 25), (-8, 8)),
    "head": ((-8, 10), (-15, 15), (-6, 6)),
    "left_hip": ((-45, 10), (-15, 15), (0, 20)),
    "left_knee": ((0, 55), (-3, 3), (-2, 2)),
    "left_ankle": ((-10, 15), (-8, 8), (-4, 4)),
    "left_foot": ((-8, 8), (-3, 3), (-2, 2)),
    "left_collar": ((-3, 3), (-8, 8), (-5, 12)),
    "left_shoulder": ((-35, 35), (-80, 15), (-72, 50)),
    "left_elbow": ((-50, 50), (-115, 0), (-3, 3)),
    "left_wrist": ((-15, 15), (-20, 20), (-35, 35)),
}
"""Turns about x, y and z in which chance draws, degrees; those of the right side are the mirror image's."""


def a_pose() -> Array:
    """(52, 3) rad: arms lowered, legs a little apart, all else as at rest."""
    pose = np.zeros((len(SMPLH_JOINTS), 3))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        pose[BODY_JOINTS.index(f"{side}_shoulder"), 2] = -sign * np.radians(A_POSE_DEG)
        pose[BODY_JOINTS.index(f"{side}_hip"), 2] = sign * np.radians(7.0)
    return pose


def draw_pose(person: Person, rng: np.random.Generator, wildness: float = 1.0) -> Array:
    """(52, 3) rad, the root upright and turned about y; arms and legs are not inside the rest of the body.

    Args:
        person: Who stands so.
        rng: Chance.
        wildness: Share of the ranges that is used, about the A-pose.
    """
    pose = a_pose()
    for _ in range(MAX_DRAWS):
        pose = a_pose() + 0.0
        middle = a_pose()
        for name, ranges in RANGES_DEG.items():
            for side in ("left", "right") if name.startswith("left") else ("",):
                joint = BODY_JOINTS.index(name.replace("left", side) if side else name)
                turn = _compose(np.radians([rng.uniform(*each) for each in ranges]))
                turn = turn * MIRRORED if side == "right" else turn
                pose[joint] = middle[joint] + wildness * (turn - middle[joint])
        for side in ("left", "right"):
            pose[body_hand(person.model, side).fingers] = draw_hand(side, rng)
        if not is_entangled(person, pose):
            break
    pose[0] = [0.0, rng.uniform(-np.pi, np.pi), 0.0]
    return pose


def draw_hand(side: str, rng: np.random.Generator) -> Array:
    """(15, 3) rad, a pose of somebody whom nothing was learnt from."""
    poses = load_hand_poses()[0]
    pose = poses[int(rng.integers(len(poses)))]
    return pose if side == "right" else pose * MIRRORED


def is_entangled(person: Person, pose: Array) -> bool:
    """Whether a forearm with its hand lies in the body, or a leg in the other."""
    vertices, _ = person.posed(pose, np.zeros(3))
    normals = find_unit_normals(vertices, person.model.faces)
    heaviest = person.model.skinning_weights.argmax(axis=1)
    names = np.array([SMPLH_JOINTS[bone] for bone in heaviest])
    hands = [body_hand(person.model, side) for side in ("left", "right")]
    arms = [np.isin(heaviest, [hand.elbow, hand.wrist, *hand.fingers]) for hand in hands]
    uppers = np.isin(names, ["left_shoulder", "right_shoulder", "left_collar", "right_collar"])
    left_leg = np.isin(names, ["left_knee", "left_ankle", "left_foot"])
    right_leg = np.isin(names, ["right_knee", "right_ankle", "right_foot"])
    trunk = ~arms[0] & ~arms[1] & ~uppers
    pairs = ((arms[0], trunk | arms[1]), (arms[1], trunk | arms[0]), (left_leg, right_leg))
    for part, rest in pairs:
        _, nearest = KDTree(vertices[rest]).query(vertices[part])
        apart = vertices[part] - vertices[rest][nearest]
        depth = -np.einsum("nx,nx->n", apart, normals[rest][nearest])
        if np.count_nonzero(depth > DEPTH) > MAX_INSIDE:
            return True
    return False


def _compose(angles: Array) -> Array:
    """(3,) rotation vector of a turn about x, then y, then z (3,), rad."""
    return Rotation.from_euler("xyz", angles).as_rotvec()

"""Poses of T16's real motions, worn by the generator's people."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from tracker.errors import TrackerError
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.mirroring import MIRROR
from tracker.synthesis.performance import Performance
from tracker.synthesis.scans.arrange import SIDES
from tracker.synthesis.scans.deform import place_bones
from tracker.synthesis.scans.settle import settle
from tracker.synthesis.scans.subject import BONES, Subject, load_subject
from tracker.synthesis.twin import load_twin

Array = npt.NDArray[np.float64]

HABITUAL = np.radians(60.0)
"""Angles this far from the rest pose cost as much as one bone that points the wrong way by a radian."""


def load_motion_angles(folder: Path, sequence: str, side: str, moment: int, subject: int) -> Array:
    """(31,) angles for `generate_scan` in which a subject's bones point as those of a hand in T16's motion do.

    Args:
        folder: T16's, with `Cameras.txt`, `models` and `seq`.
        sequence: Such as "09".
        side: Which hand; for a left one generate the left scan.
        moment: Frame of the sequence.
        subject: 1 to 37.

    Raises:
        TrackerError: The folder has no such sequence, hand or frame.
    """
    assert side in SIDES
    actors = [hand for hand in _load_twin(folder, sequence).hands if hand.name == side]
    if not actors or not 0 <= moment < actors[0].num_moments:
        raise TrackerError(f"{folder}: sequence {sequence} has no {side} hand at frame {moment}.")
    actor = actors[0]
    joints = actor.joints(moment, actor.vertices(moment)) * (MIRROR if side == "left" else 1.0)
    return follow_joints(load_subject(subject), joints)


@lru_cache(maxsize=4)
def _load_twin(folder: Path, sequence: str) -> Performance:
    return load_twin(folder, sequence, 1500)


def follow_joints(subject: Subject, joints: Array) -> Array:
    """(31,) angles at which a subject's phalanges point, seen from the palm, as between the joints (21, 3) of a right
    hand in the order of HAND_JOINTS."""
    wanted = _seen_from_palm(joints) @ _palm_joints(subject)
    lower = np.array([dof.lower for dof in subject.dofs])
    upper = np.array([dof.upper for dof in subject.dofs])

    def residuals(angles: npt.NDArray) -> npt.NDArray:
        own = _directions(_joints_of(subject, angles))
        return np.concatenate([(own - wanted).ravel(), angles / HABITUAL * 0.1])

    start = np.clip(0.0, lower, upper)
    found = least_squares(residuals, start, bounds=(lower - 1e-9, upper + 1e-9), max_nfev=60)
    return settle(subject, np.clip(found.x, lower, upper), ())


def _joints_of(subject: Subject, angles: Array) -> Array:
    """(21, 3) in the order of HAND_JOINTS."""
    Ts = place_bones(subject, angles)
    begins = np.einsum("bij,bj->bi", Ts[:, :, :3], subject.joints) + Ts[:, :, 3]
    ends = np.einsum("bij,bj->bi", Ts[:, :, :3], subject.ends) + Ts[:, :, 3]
    joints = [begins[0]]
    for finger in FINGERS:
        first = BONES.index(f"{finger}_metacarpal") + (finger != "thumb")
        joints += [*begins[first : first + 3], ends[first + 2]]
    return np.array(joints)


def _directions(joints: Array) -> Array:
    """(15, 3) unit, along the three bones behind the first joint of each finger."""
    assert joints.shape == (len(HAND_JOINTS), 3)
    bones = np.diff(joints[1:].reshape(5, 4, 3), axis=1).reshape(-1, 3)
    return np.asarray(bones / np.linalg.norm(bones, axis=1, keepdims=True), dtype=np.float64)


def _palm(joints: Array) -> Array:
    """(3, 3) rows: along the middle metacarpal, to the thumb's side, out of the back."""
    x = joints[HAND_JOINTS.index("middle_mcp")] - joints[0]
    x = x / np.linalg.norm(x)
    z = np.cross(x, joints[HAND_JOINTS.index("index_mcp")] - joints[HAND_JOINTS.index("little_mcp")])
    z = z / np.linalg.norm(z)
    return np.asarray(np.stack([x, np.cross(z, x), z]), dtype=np.float64)


def _seen_from_palm(joints: Array) -> Array:
    return np.asarray(_directions(joints) @ _palm(joints).T, dtype=np.float64)


def _palm_joints(subject: Subject) -> Array:
    """(3, 3) rows as `_palm` of the subject at rest, which directions seen from the palm are turned back with."""
    return _palm(_joints_of(subject, np.zeros(len(subject.dofs))))

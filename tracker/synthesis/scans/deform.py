"""A subject's skin in a pose: not the linear skinning, the 16 joints or the blend shapes that models have."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from tracker.synthesis.scans.bones import dual_quaternions, pose_bones, skin
from tracker.synthesis.scans.contact import give_way
from tracker.synthesis.scans.subject import BONES, PARENTS, Subject, load_subject, load_surface
from tracker.synthesis.scans.tissue import load_tissue

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

ROLL = {"proximal": 0.8e-3, "middle": 0.6e-3, "distal": 0.4e-3}
"""How far towards the palm a phalanx's centre of rotation has moved when it is bent by 90 degrees, m."""

MOST_SWELLING = 2.5
"""Most that the pads swell, in multiples of the usual amount, to keep the volume of the hand."""


@dataclass(frozen=True)
class PosedHand:
    """A right hand, frame of the subject at rest, m.

    Attributes:
        vertices: (V, 3) of the mesh that is deformed.
        Ts: (20, 3, 4) of its bones, rest to posed.
    """

    vertices: Array
    Ts: Array


@lru_cache(maxsize=48)
def rolling(number: int) -> Array:
    """(20, 3) see ROLL."""
    subject = load_subject(number)
    rolls = np.zeros((len(BONES), 3))
    for dof, bone in zip(subject.dofs, subject.dof_bones, strict=True):
        if dof.motion == "flexion" and dof.segment in ROLL and dof.finger != "thumb":
            along = subject.ends[bone] - subject.joints[bone]
            back = np.cross(along / np.linalg.norm(along), dof.axis)
            rolls[bone] = -ROLL[dof.segment] * back
    return rolls


def place_bones(subject: Subject, angles: Array) -> Array:
    """Ts (20, 3, 4), rest to posed, for angles (31,) rad from the rest pose."""
    Ts, turned = np.empty((len(BONES), 3, 4)), np.empty_like(subject.dof_axes)
    moving = (subject.dof_bones, subject.is_abduction, subject.dof_axes, subject.joints, PARENTS)
    pose_bones(Ts, turned, angles, *moving, rolling(subject.number))
    return Ts


def deform(subject: Subject, angles: Array, strength: float = 1.0) -> PosedHand:
    """The hand for angles (31,) rad from the rest pose; strength of all that is not skinning.

    Its volume is that at rest, as far as it may: what bending takes away, the pads under the bent joints get. Where
    skin meets skin, both give way.
    """
    surface = load_surface()
    Ts = place_bones(subject, angles)
    motions = dual_quaternions(Ts)
    own, pads = load_tissue(subject.number).displace(angles, strength)
    lean = subject.vertices + own
    thin, full = np.empty_like(lean), np.empty_like(lean)
    skin(thin, lean, motions, surface.bone_ids, surface.weights)
    if strength == 0.0:
        return PosedHand(give_way(thin, subject.vertices), Ts)
    skin(full, lean + pads, motions, surface.bone_ids, surface.weights)
    wanted = closed_volume(subject.vertices, surface.faces, surface.border)
    volumes = [closed_volume(v, surface.faces, surface.border) for v in (thin, full)]
    amount = np.clip((wanted - volumes[0]) / max(volumes[1] - volumes[0], 1e-12), 0.3, MOST_SWELLING)
    if volumes[1] - volumes[0] < 1e-10:
        amount = 1.0
    return PosedHand(give_way(thin + amount * (full - thin), subject.vertices), Ts)


def closed_volume(vertices: Array, faces: Ints, border: Ints) -> float:
    """Volume, m^3, of a mesh closed by a fan over its border (L,)."""
    a, b, c = vertices[faces[:, 0]], vertices[faces[:, 1]], vertices[faces[:, 2]]
    ring = vertices[border]
    middle = ring.mean(axis=0)
    fan = np.einsum("ix,ix->", ring, np.cross(np.roll(ring, -1, axis=0), middle))
    return float(np.einsum("ix,ix->", a, np.cross(b, c)) + fan) / 6.0

"""Angles of a subject's joints in a pose: the list's, with what differs from person to person and from time to time."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.synthesis.scans.pose_list import HandPose
from tracker.synthesis.scans.subject import Subject

Array = npt.NDArray[np.float64]

HABIT, MOMENT = 4.0, 2.5
"""Standard deviations of a flexion among subjects and among one subject's repetitions, degrees; half for the rest."""


def pose_angles(subject: Subject, pose: HandPose) -> Array:
    """(31,) rad from the rest pose, as listed."""
    wanted = {
        ("thumb", "metacarpal", "flexion"): pose.thumb[0],
        ("thumb", "metacarpal", "abduction"): pose.thumb[1],
        ("thumb", "metacarpal", "twist"): pose.thumb[2],
        ("thumb", "proximal", "flexion"): pose.thumb[3],
        ("thumb", "distal", "flexion"): pose.thumb[4],
        ("ring", "metacarpal", "flexion"): 0.5 * pose.arch,
        ("little", "metacarpal", "flexion"): pose.arch,
    }
    angles = np.zeros(len(subject.dofs))
    for number, dof in enumerate(subject.dofs):
        key = (dof.finger, dof.segment, dof.motion)
        if key in wanted:
            angles[number] = np.radians(wanted[key])
        elif dof.finger != "thumb" and dof.segment != "metacarpal":
            flexion = getattr(pose, dof.finger)[("proximal", "middle", "distal").index(dof.segment)]
            spread = pose.spread[("index", "middle", "ring", "little").index(dof.finger)]
            target = {"flexion": flexion, "abduction": spread, "twist": 0.0}[dof.motion]
            rest = 0.0 if dof.motion == "twist" else rest_angle(subject, number)
            angles[number] = np.radians(target) - rest
    return angles


def rest_angle(subject: Subject, number: int) -> float:
    """Rad by which a phalanx is bent or spread at rest: from the bone before, or for the first one from the palm."""
    dof, points = subject.dofs[number], subject.chains.fingers[subject.dofs[number].finger]
    place = ("metacarpal", "proximal", "middle", "distal").index(dof.segment)
    along = points[place + 1] - points[place]
    forward, dorsal = subject.chains.forward, subject.chains.dorsal
    if dof.segment != "proximal":
        before = points[place] - points[place - 1]
    elif dof.motion == "flexion":
        before = along - (along @ dorsal) * dorsal
    else:
        before, along = forward, along - (along @ dorsal) * dorsal
    return float(np.arctan2(np.cross(before, along) @ dof.axis, before @ along))


def vary(subject: Subject, angles: Array, habit: np.random.Generator, moment: np.random.Generator) -> Array:
    """The angles as one subject, with these habits, has them at one moment; within the limits of the joints."""
    spread = np.array([1.0 if dof.motion == "flexion" else 0.5 for dof in subject.dofs])
    spread[[dof.segment == "metacarpal" and dof.finger != "thumb" for dof in subject.dofs]] = 0.3
    together = 1.0 + 0.04 * habit.normal() + 0.02 * moment.normal()
    noise = HABIT * habit.normal(size=len(angles)) + MOMENT * moment.normal(size=len(angles))
    varied = together * angles + np.radians(noise) * spread
    return clip_to_limits(subject, varied)


def clip_to_limits(subject: Subject, angles: Array) -> Array:
    lower = np.array([dof.lower for dof in subject.dofs])
    upper = np.array([dof.upper for dof in subject.dofs])
    return np.clip(angles, lower, upper)

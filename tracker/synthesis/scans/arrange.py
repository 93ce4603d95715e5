"""Who holds which hand in which pose."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.errors import TrackerError
from tracker.model.joints import SIDES
from tracker.synthesis.scans.angles import clip_to_limits, pose_angles, vary
from tracker.synthesis.scans.pose_list import POSE_NAMES, POSES
from tracker.synthesis.scans.settle import settle
from tracker.synthesis.scans.subject import Subject, load_subject

Array = npt.NDArray[np.float64]


def arrange(
    subject: int, pose: int | str | Array, side: str = "right", seed: int = 0, is_varied: bool = True
) -> tuple[Subject, str, Array]:
    """Who it is, the name of the pose ("given" for angles), and the angles (31,) rad from the rest pose.

    For the arguments see `generate_truth`.

    Raises:
        TrackerError: There is no such subject, pose or side.
    """
    if side not in SIDES:
        raise TrackerError(f"A hand is 'right' or 'left', not {side!r}.")
    if subject == 0:
        raise TrackerError("There is no subject 0; subjects are numbered from 1.")
    person = load_subject(subject)
    if isinstance(pose, np.ndarray):
        if pose.shape != (len(person.dofs),) or not np.isfinite(pose).all():
            raise TrackerError(
                f"A pose is {len(person.dofs)} angles; got an array {pose.shape}, or not all are numbers."
            )
        return person, "given", pose.astype(np.float64)
    if isinstance(pose, str):
        if pose not in POSE_NAMES:
            raise TrackerError(f"There is no pose {pose!r}; choose one of {', '.join(POSE_NAMES)}.")
        pose = POSE_NAMES.index(pose)
    if not 0 <= pose < len(POSES):
        raise TrackerError(f"There is no pose {pose}; there are 0 to {len(POSES) - 1}.")
    angles = pose_angles(person, POSES[pose])
    if is_varied:
        habit = np.random.default_rng([subject, pose, 0])
        moment = np.random.default_rng([subject, pose, SIDES.index(side), seed, 0])
        angles = vary(person, angles, habit, moment)
    return person, POSE_NAMES[pose], settle(person, clip_to_limits(person, angles), POSES[pose].touches)

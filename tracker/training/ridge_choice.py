"""How strongly pose blend shapes are held down, chosen by people that they were not learnt from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.training.pose_fit import Poses, Rig, fit_poses
from tracker.training.pose_shapes import fit_pose_shapes

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

ONE_IN = 4
"""One person of so many is left out."""

MOST = 150
"""Registrations that are judged, at most."""

AS_GOOD = 1.25
"""Of weights whose error is at most so many times the least, the largest is chosen. With a template of one's own that
costs some 0.03 mm, with the shape fitted too nothing; blend shapes stay nearer to their joints, and joints are right.
"""


def choose_ridge(
    ridges: tuple[float, ...],
    targets: Array,
    owners: Integers,
    people: Integers,
    poses: Poses,
    joints: Array,
    rig: Rig,
    features: Array,
    rest: Array,
    costs: Array,
    threads: int,
) -> tuple[float, dict[float, float]]:
    """The weight, and the error by weight, m: root mean square distance to registrations of people left out.

    Their poses are fitted again with the blend shapes that are judged: what a change of pose does as well is no gain.

    Args:
        ridges: To choose from.
        targets: (N, V, 3) m; owners (N,) which hand; people (N,) whose.
        poses, joints (S, B, 3), rig: So far.
        features (N, 9K), rest (N, V, 3), costs (V, 9K): As in `fit_pose_shapes`.
        threads: Poses fitted at a time.
    """
    is_out = people % ONE_IN == 0
    if len(ridges) == 1 or not is_out.any() or is_out.all():
        return ridges[0], {}
    judged = np.flatnonzero(is_out)
    judged = judged[np.linspace(0, len(judged) - 1, min(MOST, len(judged))).astype(int)]
    start = Poses(poses.rotations[judged], poses.translations[judged], poses.errors[judged])
    errors: dict[float, float] = {}
    for ridge in ridges:
        directions = fit_pose_shapes(features[~is_out], rest[~is_out], owners[~is_out], costs, ridge)
        templates = np.zeros((len(joints), *rest.shape[1:]))
        for hand in np.unique(owners[judged]):
            mine = owners == hand
            templates[hand] = rest[mine].mean(0) - directions @ features[mine].mean(0)
        found = fit_poses(
            start, targets[judged], templates, owners[judged], joints, replace(rig, directions=directions), 3, threads
        )
        errors[ridge] = float(np.sqrt(np.mean(found.errors**2)))
    least = min(errors.values())
    return max(ridge for ridge, error in errors.items() if error <= AS_GOOD * least), errors

"""Where the hand detector's hands are against each other, and how long their bones are in space."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from server.quality.bones import limit_bones
from server.quality.doubt import Doubt
from server.quality.evidence import DETECTOR_PX, DETECTOR_SHARE, LEAST_JOINTS
from server.quality.hand import EDGES, joint_name
from server.quality.labels import find_median
from server.quality.views import Marks, Views, measure_size, triangulate_views

if TYPE_CHECKING:
    from tracker import Camera


LEAST_M, LEAST_SHARE = 0.006, 0.05
"""A bone between triangulated joints that is off by less than this, m, and this share is as long as usual: marks that
are 1.5 px off ([T16] §4.2) move a joint by 2 to 3 mm."""


def check_detections(detected: Marks, cameras: Mapping[str, Camera]) -> Iterator[Doubt]:
    """Cameras whose detection the others do not agree with, and bones of a length that they usually do not have."""
    views = triangulate_views(detected, cameras)
    for view in views:
        yield from _check_left_out(view, detected)
    yield from check_bones_in_space(views, "what the detector saw")


def _check_left_out(view: Views, detected: Marks) -> Iterator[Doubt]:
    """With two cameras both are as far off: which of them is wrong cannot be told."""
    for column, camera in enumerate(view.cameras):
        left_out = view.left_out[:, column] if len(view.cameras) > 2 else view.residuals[:, column]
        if np.isfinite(left_out).sum() < LEAST_JOINTS:
            continue
        apart = float(find_median(left_out))
        limit = max(DETECTOR_PX, DETECTOR_SHARE * measure_size(detected[camera, view.frame, view.hand]))
        others = "the other cameras see" if len(view.cameras) > 2 else "both cameras together put"
        reason = f"In {camera} the detector saw the hand {apart:.0f} px from where {others} it."
        yield Doubt(view.frame, view.hand, "left_out", min(10.0, apart / limit), camera, (), reason)


def check_bones_in_space(views: Sequence[Views], of_what: str) -> Iterator[Doubt]:
    """Bones between triangulated joints against this recording's median; `of_what` was triangulated."""
    for hand in sorted({view.hand for view in views}):
        own = [view for view in views if view.hand == hand]
        found = np.stack([np.linalg.norm(view.points[EDGES[:, 0]] - view.points[EDGES[:, 1]], axis=1) for view in own])
        usual, limit = limit_bones(found, LEAST_M, LEAST_SHARE)
        off = np.abs(found - usual) / limit
        for row, view in enumerate(own):
            if not np.isfinite(off[row]).any():
                continue
            bone = int(np.nanargmax(off[row]))
            a, b = (int(joint) for joint in EDGES[bone])
            reason = (
                f"By {of_what}, {joint_name(a)} to {joint_name(b)} is {1e3 * found[row, bone]:.0f} mm; "
                f"in this recording it usually is {1e3 * usual[bone]:.0f} mm."
            )
            yield Doubt(view.frame, hand, "bones", min(10.0, float(off[row, bone])), "", (a, b), reason)

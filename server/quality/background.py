"""Checks of joints that lie where no hand is: in the empty part of an image, or on what is behind the hand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from server.quality.finding import Finding, Looked
from server.quality.hand import EDGES, find_bone_lengths, joint_name
from server.quality.labels import Label

if TYPE_CHECKING:
    from tracker import Camera

Array = npt.NDArray[np.float64]

LEAST_BONES = 8
"""Bones that must be seen in the image to know how far away a hand is."""
LARGE_HAND = 1.35
"""A hand as large as this times the default one is the largest that there is."""
BEHIND_M = 0.1
"""Depth may lie this far behind the hand's distance, which is only guessed, m."""


def check_background(labels: Sequence[Label], cameras: dict[str, Camera], looked: Looked) -> Iterator[Finding]:
    """Joints in the empty part of an image, visible ones without depth, and ones whose depth is behind the hand."""
    for label in labels:
        yield from _check_empty(label, looked)
        yield from _check_behind(label, cameras[label.camera].K, looked)


def _check_empty(label: Label, looked: Looked) -> Iterator[Finding]:
    """A mark may be a little beside the silhouette; real depth cameras leave holes as wide as a finger."""
    around = label.around
    ways = (
        (around.to_content, max(6.0, 0.05 * label.size_px), "anything that this image shows"),
        (around.to_depth, max(12.0, 0.15 * label.size_px), "the nearest depth, though it is marked as visible"),
    )
    for distance, limit, of_what in ways:
        if not np.isfinite(distance).any():
            continue
        looked.at("background", label)
        joints = np.flatnonzero(distance > limit)
        if joints.size:
            worst = joints[np.argmax(distance[joints])]
            more = joints.size - 1
            others = (
                f"; so {'is' if more == 1 else 'are'} {more} other {'joint' if more == 1 else 'joints'}" if more else ""
            )
            reason = f"The {joint_name(worst)} is {distance[worst]:.0f} px from {of_what}{others}."
            yield Finding(
                label, "background", min(10.0, float(distance[worst] / limit)), tuple(map(int, joints)), reason
            )


def _check_behind(label: Label, K: Array, looked: Looked) -> Iterator[Finding]:
    """How long bones look says how far away a hand is at most, whatever the other labels of the recording say."""
    if not np.isfinite(label.depth).any():
        return
    seen = np.linalg.norm((label.pixels[EDGES[:, 0]] - label.pixels[EDGES[:, 1]]) / K[[0, 1], [0, 1]], axis=1)
    is_long = np.isfinite(seen) & (seen > 1e-6)
    if is_long.sum() < LEAST_BONES:
        return
    looked.at("background", label)
    farthest = LARGE_HAND * float(np.percentile(find_bone_lengths()[is_long] / seen[is_long], 20)) + BEHIND_M
    nearest = label.depths[:, 0]
    joints = np.flatnonzero(nearest > farthest)
    if joints.size >= 2:  # a single one is compared with its neighbours by `check_depth`
        worst = joints[np.argmax(nearest[joints])]
        reason = (
            f"The depth at the {joint_name(worst)} is {nearest[worst]:.2f} m; a hand that looks as large as this one "
            f"is at most {farthest:.2f} m away: is it on the background?"
        )
        score = 1.0 + float(nearest[worst] - farthest) / 0.3
        yield Finding(label, "background", min(10.0, score), tuple(map(int, joints)), reason)

"""Checks of a label against what else is known: other cameras, a track, the hand detector."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from server.quality.finding import Finding, Kind, Looked
from server.quality.hand import joint_name
from server.quality.labels import Label, find_median
from server.quality.usual import compare_with_usual
from server.quality.views import Marks, triangulate_views

if TYPE_CHECKING:
    from tracker import Camera


def check_reprojection(labels: Sequence[Label], cameras: dict[str, Camera], looked: Looked) -> Iterator[Finding]:
    """Joints that lie beside where the other cameras' labels put them."""
    by_place = {(label.camera, label.frame, label.hand): label for label in labels}
    for views in triangulate_views({place: label.pixels for place, label in by_place.items()}, cameras):
        for column, camera in enumerate(views.cameras):
            label = by_place[camera, views.frame, views.hand]
            residual = views.residuals[:, column]
            if not np.isfinite(residual).any():
                continue
            looked.at("reprojection", label)
            limit = max(6.0, 0.03 * label.size_px)
            if np.nanmax(residual) > limit:
                joint = int(np.nanargmax(residual))
                joints = tuple(int(j) for j in np.flatnonzero(residual > limit))
                reason = f"The {joint_name(joint)} is {residual[joint]:.0f} px from where the other cameras put it."
                yield Finding(label, "reprojection", min(10.0, float(residual[joint] / limit)), joints, reason)


LEAST_JOINTS = 4
"""Joints of a hand that must be compared with a track to say something of the whole hand."""
APART_PX, APART_SHARE = 8.0, 0.08
"""A label and a track of which half the joints are farther apart than this, and than this share of the hand, are not
of the same pose: 8 % of a hand is a finger's width."""


def check_residuals(labels: Sequence[Label], tracked: Marks, looked: Looked) -> Iterator[Finding]:
    """Labels that are not where the track has the hand, and joints farther from it than that joint usually is.

    `tracked` holds (21, 2) px by place. Joints that a track had a part in say nothing here and are left out.
    """
    known = [
        (label, tracked[place]) for label in labels if (place := (label.camera, label.frame, label.hand)) in tracked
    ]
    if not known:
        return
    distances = np.stack(
        [
            np.where(label.is_independent, np.linalg.norm(label.pixels - joints, axis=1), np.nan)
            for label, joints in known
        ]
    )
    compared = np.asarray(np.isfinite(distances).any(axis=1))
    least = np.array([max(10.0, 0.08 * label.size_px) for label, _ in known])
    beyond, usual = compare_with_usual(distances, least)
    whole = np.where(np.isfinite(distances).sum(axis=1) >= LEAST_JOINTS, find_median(distances, axis=1), np.nan)
    limits = np.array([max(APART_PX, APART_SHARE * label.size_px) for label, _ in known])
    apart = whole > limits
    for row, (label, _) in enumerate(known):
        if not compared[row]:
            continue
        looked.at("residual", label)
        distance = distances[row]
        off = beyond[row]
        if apart[row]:
            hands = f"as in {apart.sum()} of {compared.sum()} hands that were compared"
            reason = f"The label and the track are {whole[row]:.0f} px apart, {hands}: one of the two is wrong."
            yield Finding(label, "residual", min(10.0, float(whole[row] / limits[row])), (), reason)
        if np.isfinite(off).any() and np.nanmax(off) > 1:
            joint = int(np.nanargmax(off))
            joints = tuple(int(j) for j in np.flatnonzero(off > 1))
            usually = f"usually it is {usual[joint]:.1f} px"
            reason = f"The {joint_name(joint)} is {distance[joint]:.0f} px from the track; {usually}."
            yield Finding(label, "residual", min(10.0, float(off[joint])), joints, reason)


DETECTOR_PX, DETECTOR_SHARE = 12.0, 0.15
"""A label and the hand detector of which half the joints are farther apart than this, and than this share of the hand,
are not of the same pose. The detector is 5 to 7 px off on hands of 200 px, 11 at its worst tenth."""

OTHERS: tuple[Kind, ...] = ("residual", "handedness", "jump")
"""Checks that know more of where a hand is than the detector does."""


def check_detected(labels: Sequence[Label], detected: Marks, looked: Looked) -> Iterator[Finding]:
    """Labels that are not where the hand detector sees the hand, where neither a track nor neighbours speak.

    `detected` holds (21, 2) px by place, NaN where a joint is outside the image.
    """
    spoken_of = frozenset[uuid.UUID]().union(*(looked.find(kind) for kind in OTHERS))
    for label in labels:
        joints = detected.get((label.camera, label.frame, label.hand))
        if joints is None or label.id in spoken_of:
            continue
        distances = np.where(label.is_independent, np.linalg.norm(label.pixels - joints, axis=1), np.nan)
        if np.isfinite(distances).sum() < LEAST_JOINTS:
            continue
        looked.at("detector", label)
        apart, limit = float(np.nanmedian(distances)), max(DETECTOR_PX, DETECTOR_SHARE * label.size_px)
        if apart > limit:
            reason = f"The label and the hand detector are {apart:.0f} px apart: one of the two is wrong."
            yield Finding(label, "detector", min(10.0, apart / limit), (), reason)

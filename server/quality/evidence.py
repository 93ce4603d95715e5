"""Checks of a label against what else is known: other cameras, a track."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from server.quality.finding import Finding
from server.quality.hand import joint_name
from server.quality.labels import Label, find_median

if TYPE_CHECKING:
    from tracker import Camera

Array = npt.NDArray[np.float64]


def check_reprojection(labels: Sequence[Label], cameras: dict[str, Camera]) -> Iterator[Finding]:
    """Joints that lie beside where the other cameras' labels put them."""
    from tracker import triangulate

    together: dict[tuple[int, str], list[Label]] = defaultdict(list)
    for label in labels:
        together[label.frame, label.hand].append(label)
    for views in together.values():
        if len(views) < 2:
            continue
        marks = np.ascontiguousarray(np.stack([view.pixels for view in views], axis=1))
        found = triangulate([cameras[view.camera] for view in views], marks)
        for column, view in enumerate(views):
            residual = found.residuals[:, column]
            limit = max(6.0, 0.03 * view.size_px)
            if np.isfinite(residual).any() and np.nanmax(residual) > limit:
                joint = int(np.nanargmax(residual))
                joints = tuple(int(j) for j in np.flatnonzero(residual > limit))
                reason = f"The {joint_name(joint)} is {residual[joint]:.0f} px from where the other cameras put it."
                yield Finding(view, "reprojection", min(10.0, float(residual[joint] / limit)), joints, reason)


def check_residuals(labels: Sequence[Label], tracked: dict[tuple[str, int, str], Array]) -> Iterator[Finding]:
    """Joints farther from the track than that joint of the track usually is; `tracked` holds (21, 2) px by place."""
    known = [
        (label, tracked[place]) for label in labels if (place := (label.camera, label.frame, label.hand)) in tracked
    ]
    if not known:
        return
    distances = np.stack([np.linalg.norm(label.pixels - joints, axis=1) for label, joints in known])
    usual = find_median(distances, axis=0)
    spread = 1.4826 * find_median(np.abs(distances - usual), axis=0)
    for (label, _), distance in zip(known, distances, strict=True):
        limit = np.maximum(usual + 6 * spread, np.maximum(10.0, 0.08 * label.size_px))
        off = distance / limit
        if np.isfinite(off).any() and np.nanmax(off) > 1:
            joint = int(np.nanargmax(off))
            joints = tuple(int(j) for j in np.flatnonzero(off > 1))
            usually = f"usually it is {usual[joint]:.1f} px"
            reason = f"The {joint_name(joint)} is {distance[joint]:.0f} px from the track; {usually}."
            yield Finding(label, "residual", min(10.0, float(off[joint])), joints, reason)

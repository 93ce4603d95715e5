"""World positions of labelled joints, for formats that hold nothing else."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotation
from tracker.capture.camera import Camera
from tracker.capture.triangulation import triangulate
from tracker.errors import TrackerError
from tracker.label_formats.label_set import LabelSet, Notes
from tracker.model.joints import HAND_JOINTS

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Hand3D:
    """One hand in one frame.

    Attributes:
        frame: Frame number.
        hand: `right` or `left`.
        points: (21, 3) world, m, NaN where unknown.
        labels: What was marked of it, by camera.
    """

    frame: int
    hand: str
    points: Array
    labels: dict[str, Annotation]


def find_hands_3d(labels: LabelSet, notes: Notes) -> list[Hand3D]:
    """Every labelled hand with what is known of it in 3D: from the track if one is given, else from two views that
    mark a joint, else from the depth under a visible joint. Notes say how many came from where, and how many are lost.
    """
    groups: dict[tuple[int, str], dict[str, Annotation]] = {}
    for item in labels.annotations.items:
        groups.setdefault((item.frame, item.hand), {})[item.camera] = item
    depths = _DepthReader(labels)
    hands = []
    for (frame, hand), views in sorted(groups.items()):
        marked = np.any([view.points[:, 2] > 0 for view in views.values()], axis=0)
        points = np.full((len(HAND_JOINTS), 3), np.nan)
        if labels.track_joints:
            points = labels.track_joints.get((frame, hand), points)
            notes.add("{n} [joint is that of|joints are those of] a track, a machine's guess, not what people marked",
                      count=int(np.isfinite(points).all(axis=1).sum()))  # fmt: skip
        else:
            points = _find_points(labels, views, marked, depths, notes)
        known = np.isfinite(points).all(axis=1)
        notes.add(
            "{n} labelled [joint has|joints have] no known position in 3D and [was|were] left out",
            count=int((marked & ~known).sum()),
        )
        hands.append(Hand3D(frame, hand, points, views))
    return hands


def _find_points(
    labels: LabelSet, views: dict[str, Annotation], marked: Mask, depths: _DepthReader, notes: Notes
) -> Array:
    points = np.full((len(HAND_JOINTS), 3), np.nan)
    names = list(views)
    marks = np.stack([np.where(view.points[:, 2:] > 0, view.points[:, :2], np.nan) for view in views.values()], axis=1)
    if len(names) >= 2:
        points = triangulate([labels.sequence.camera(name) for name in names], marks).points
        notes.add(
            "{n} [joint was|joints were] triangulated from two or more cameras",
            count=int(np.isfinite(points).all(axis=1).sum()),
        )
    for name, view in views.items():
        camera = labels.sequence.camera(name)
        for joint in np.flatnonzero(marked & np.isnan(points).any(axis=1) & (view.points[:, 2] == 2)):
            pixel = view.points[joint, :2]
            z = depths.at(name, view.frame, *pixel)
            if z > 0:
                notes.add(
                    "{n} [joint is|joints are] on the skin, where the depth was read; the joint itself lies deeper"
                )
                ray = camera.unproject(pixel[None])[0]
                points[joint] = camera.T_world_camera[:3, :3] @ (z * ray) + camera.T_world_camera[:3, 3]
    return points


class _DepthReader:
    """Depth under pixels; reads each image once, since labels come frame by frame."""

    def __init__(self, labels: LabelSet) -> None:
        self._labels = labels
        self._last: tuple[str, int] | None = None
        self._depth: npt.NDArray[np.uint16] | None = None

    def at(self, camera: str, frame: int, x: float, y: float) -> float:
        """m, 0 where there is none."""
        if not self._labels.sequence.camera(camera).has_depth:
            return 0.0
        if self._last != (camera, frame):
            self._last = (camera, frame)
            try:
                self._depth = self._labels.sequence.depth_raw(frame, camera)
            except TrackerError:
                self._depth = None
        column, row = round(x), round(y)
        if self._depth is None or not (0 <= row < self._depth.shape[0] and 0 <= column < self._depth.shape[1]):
            return 0.0
        return float(self._depth[row, column]) * self._labels.sequence.camera(camera).depth_scale


def project_hand(camera: Camera, points: Array, valid: Mask) -> Array:
    """(21, 3) x, y, v of world points: visible in the image, outside (v = 0, not at the origin) beyond it, absent
    where not valid or behind the camera."""
    result = np.zeros((len(points), 3))
    if valid.any():
        pixels = np.full((len(points), 2), np.nan)
        pixels[valid] = camera.project(points[valid])
        there = np.isfinite(pixels).all(axis=1)
        inside = there & (pixels >= -0.5).all(axis=1) & (pixels < [camera.width - 0.5, camera.height - 0.5]).all(axis=1)
        result[inside] = np.c_[pixels[inside], np.full(inside.sum(), 2.0)]
        result[there & ~inside, :2] = -1.0
    return result

"""A track against the joints that people marked, by the protocol of [T16] §4.1.

The error of a joint is the distance in the image, px, between its projection and its annotation. Every annotated joint
counts, occluded or not; one marked absent does not. Frames that the tracker calls lost count like any other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotations
from tracker.evaluation.statistics import Statistics, compute_statistics
from tracker.model.joints import HAND_JOINTS

if TYPE_CHECKING:
    from tracker.tracking.track import Track

Array = npt.NDArray[np.float64]

OCCLUDED, VISIBLE = 1, 2


@dataclass(frozen=True)
class Evaluation:
    """Errors of a track at N annotated hands, an item being one hand in one image.

    Attributes:
        frame: (N,).
        camera: N ids.
        hand: N of "right", "left".
        status: N, what the tracker said of the frame: "ok", "lost" or "recovered".
        error: (N, 21) px in the order of HAND_JOINTS; NaN where the joint is marked absent or does not project.
        visibility: (N, 21) 0 absent, 1 occluded, 2 visible.
        untracked: Annotated (frame, camera, hand) that the track does not hold.
    """

    frame: npt.NDArray[np.int64]
    camera: tuple[str, ...]
    hand: tuple[str, ...]
    status: tuple[str, ...]
    error: Array
    visibility: npt.NDArray[np.int64]
    untracked: tuple[tuple[int, str, str], ...]

    def __post_init__(self) -> None:
        items = len(self.frame)
        assert len(self.camera) == len(self.hand) == len(self.status) == items
        assert self.error.shape == self.visibility.shape == (items, len(HAND_JOINTS))

    @property
    def statistics(self) -> Statistics:
        """Over all joints of all items, px."""
        return compute_statistics(self.error)

    @property
    def item_mean(self) -> Array:
        """(N,) mean error of each item, px; NaN where no joint counts."""
        count = np.isfinite(self.error).sum(axis=1)
        total = np.nansum(self.error, axis=1)
        return np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)

    def worst_items(self, most: int = 10) -> list[int]:
        """Places of the items with the largest mean error, worst first."""
        mean = self.item_mean
        order = np.argsort(-np.nan_to_num(mean, nan=-1.0), kind="stable")
        return [int(item) for item in order[:most] if np.isfinite(mean[item])]

    def to_json(self) -> dict[str, Any]:
        """Statistics over all, by visibility, hand and joint; every item; the worst items. Errors in px."""
        return {
            "joint_error_px": self.statistics.to_json(),
            "visible_error_px": self._where(self.visibility == VISIBLE),
            "occluded_error_px": self._where(self.visibility == OCCLUDED),
            "hands": {
                hand: self._where(np.array([name == hand for name in self.hand])[:, None])
                for hand in sorted(set(self.hand))
            },
            "joints": [
                {"joint": joint, **compute_statistics(self.error[:, j]).to_json()}
                for j, joint in enumerate(HAND_JOINTS)
            ],
            "items": [self._item(item) for item in range(len(self.frame))],
            "worst": [self._item(item) for item in self.worst_items()],
            "annotated": len(self.frame) + len(self.untracked),
            "evaluated": len(self.frame),
            "untracked": [{"frame": f, "camera": c, "hand": h} for f, c, h in self.untracked],
        }

    def _where(self, mask: npt.NDArray[np.bool_]) -> dict[str, Any]:
        return compute_statistics(np.where(mask, self.error, np.nan)).to_json()

    def _item(self, item: int) -> dict[str, Any]:
        known = compute_statistics(self.error[item])
        return {
            "frame": int(self.frame[item]),
            "camera": self.camera[item],
            "hand": self.hand[item],
            "status": self.status[item],
            "mean_px": known.mean,
            "max_px": known.max,
            "joints": known.count,
        }


def evaluate_track(track: Track, annotations: Annotations) -> Evaluation:
    """Errors of a track at every annotated hand that it holds."""
    places = {int(frame): place for place, frame in enumerate(track.frame)}
    cameras = {camera: c for c, camera in enumerate(track.camera_ids)}
    columns = {name: j for j, name in enumerate(track.joint_names)}
    evaluated, untracked, errors, visibilities = [], [], [], []
    for item in annotations.items:
        names = [f"{item.hand}/{joint}" for joint in HAND_JOINTS]
        if item.frame not in places or item.camera not in cameras or names[0] not in columns:
            untracked.append(item.key)
            continue
        own = [columns[name] for name in names]
        projected = track.joints_2d[places[item.frame], cameras[item.camera], own]
        visibility = item.points[:, 2].astype(np.int64)
        distance = np.linalg.norm(projected - item.points[:, :2], axis=1)
        evaluated.append(item)
        errors.append(np.where(visibility > 0, distance, np.nan))
        visibilities.append(visibility)
    shape = (len(evaluated), len(HAND_JOINTS))
    return Evaluation(
        frame=np.array([item.frame for item in evaluated], dtype=np.int64),
        camera=tuple(item.camera for item in evaluated),
        hand=tuple(item.hand for item in evaluated),
        status=tuple(str(track.status[places[item.frame]]) for item in evaluated),
        error=np.array(errors, dtype=np.float64).reshape(shape),
        visibility=np.array(visibilities, dtype=np.int64).reshape(shape),
        untracked=tuple(untracked),
    )

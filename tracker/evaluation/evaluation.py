"""A track against the joints that people marked, by the protocol of [T16] §4.1.

The error of a joint is the distance in the image, px, between its projection and its annotation. Every annotated joint
counts, occluded or not; one marked absent does not. Frames that the tracker calls lost count like any other. Joints
that a track had a part in do not count unless asked for: a track must not judge itself (`source_choice`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import compress
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import OCCLUDED, VISIBLE, Annotation, Annotations
from tracker.capture.joint_source import JointSources
from tracker.capture.source_choice import ALL, JUDGING, count_origins, describe_origin, find_counted, find_origin
from tracker.evaluation.statistics import Statistics, compute_statistics
from tracker.model.joints import HAND_JOINTS

if TYPE_CHECKING:
    from tracker.tracking.track import Track

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Evaluation:
    """Errors of a track at N annotated hands, an item being one hand in one image.

    Attributes:
        frame: (N,).
        camera: N ids.
        hand: N of "right", "left".
        status: N, what the tracker said of the frame: "ok", "lost" or "recovered".
        error: (N, 21) px in the order of HAND_JOINTS; NaN where the joint is marked absent, does not project or does
            not count.
        visibility: (N, 21) 0 absent, 1 occluded, 2 visible.
        marked: (N, 21, 2) px, where people marked the joints.
        tracked: (N, 21, 2) px, where the track has them; NaN where one does not project.
        untracked: Annotated (frame, camera, hand) that the track does not hold.
        track_frame: (T,) all frames of the track.
        lost_frame: (L,) those that the tracker calls lost.
        sources: N, where the joints of each item came from.
        left_out: (N, 21) joints that do not count because of where they came from.
    """

    frame: npt.NDArray[np.int64]
    camera: tuple[str, ...]
    hand: tuple[str, ...]
    status: tuple[str, ...]
    error: Array
    visibility: npt.NDArray[np.int64]
    marked: Array
    tracked: Array
    untracked: tuple[tuple[int, str, str], ...]
    track_frame: npt.NDArray[np.int64]
    lost_frame: npt.NDArray[np.int64]
    sources: tuple[JointSources | None, ...]
    left_out: npt.NDArray[np.bool_]

    def __post_init__(self) -> None:
        items = len(self.frame)
        assert len(self.camera) == len(self.hand) == len(self.status) == items
        assert len(self.sources) == items
        assert self.error.shape == self.visibility.shape == self.left_out.shape == (items, len(HAND_JOINTS))
        assert self.marked.shape == self.tracked.shape == (items, len(HAND_JOINTS), 2)

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

    @property
    def is_judged(self) -> npt.NDArray[np.bool_]:
        """(N,) items that judge: not those whose joints are all left out."""
        return np.asarray(np.isfinite(self.error).any(axis=1) | ~self.left_out.any(axis=1))

    def count_sources(self) -> list[dict[str, Any]]:
        """How many joints count, and how many are left out, by where they came from."""
        counted = (self.visibility > 0) & ~self.left_out & np.isfinite(self.error)
        return [
            {"origin": origin, "words": words, "joints": joints, "is_counted": is_counted}
            for is_counted, mask in ((True, counted), (False, self.left_out))
            for (origin, words), joints in count_origins(
                (find_origin(self.sources[item], joint), describe_origin(self.sources[item], joint))
                for item, joint in np.argwhere(mask).tolist()
            )
        ]

    def select(
        self,
        *,
        camera: str = "",
        hand: str = "",
        visibility: int | None = None,
        without_start: bool = False,
        sources: Sequence[str] = (ALL,),
    ) -> Evaluation:
        """What is left with one camera, one hand, joints of one visibility, or without the frame the track began at.

        Empty and None take all. `sources` are SOURCE_CHOICES, of which a joint must be one.
        """
        keys = zip(self.camera, self.hand, strict=True)
        kept = np.array([camera in ("", c) and hand in ("", h) for c, h in keys], dtype=bool)
        if without_start and len(self.track_frame):
            kept &= self.frame != self.track_frame[0]
        own = self._take(kept)
        error = own.error
        if visibility is not None:
            error = np.where(own.visibility == visibility, error, np.nan)
        excluded = ~np.array([find_counted(one, sources) for one in own.sources], dtype=bool).reshape(error.shape)
        left_out = own.left_out | (excluded & np.isfinite(error))
        untracked = tuple(key for key in self.untracked if camera in ("", key[1]) and hand in ("", key[2]))
        return replace(own, error=np.where(left_out, np.nan, error), left_out=left_out, untracked=untracked)

    def _take(self, kept: npt.NDArray[np.bool_]) -> Evaluation:
        """Only the items of a mask (N,)."""
        arrays = ("frame", "error", "visibility", "marked", "tracked", "left_out")
        tuples = ("camera", "hand", "status", "sources")
        return replace(
            self,
            **{name: getattr(self, name)[kept] for name in arrays},
            **{name: tuple(compress(getattr(self, name), kept)) for name in tuples},
        )

    def where(self, mask: npt.NDArray[np.bool_]) -> Statistics:
        """Over the joints of a mask that broadcasts to (N, 21), px."""
        return compute_statistics(np.where(mask, self.error, np.nan))

    def by_hand(self) -> dict[str, Statistics]:
        """For each hand, px."""
        return {hand: self.where(_is(self.hand, hand)) for hand in sorted(set(self.hand))}

    def by_camera(self) -> dict[str, Statistics]:
        """For each camera, px."""
        return {camera: self.where(_is(self.camera, camera)) for camera in sorted(set(self.camera))}

    def by_joint(self) -> list[Statistics]:
        """For each of the 21 joints, px."""
        return [compute_statistics(self.error[:, j]) for j in range(len(HAND_JOINTS))]

    def worst_items(self, most: int = 10) -> list[int]:
        """Places of the items with the largest mean error, worst first."""
        mean = self.item_mean
        order = np.argsort(-np.nan_to_num(mean, nan=-1.0), kind="stable")
        return [int(item) for item in order[:most] if np.isfinite(mean[item])]

    def to_json(self) -> dict[str, Any]:
        """Statistics over all, by visibility, hand and joint; every item; the worst items. Errors in px."""
        return {
            "joint_error_px": self.statistics.to_json(),
            "visible_error_px": self.where(self.visibility == VISIBLE).to_json(),
            "occluded_error_px": self.where(self.visibility == OCCLUDED).to_json(),
            "hands": {hand: found.to_json() for hand, found in self.by_hand().items()},
            "cameras": {camera: found.to_json() for camera, found in self.by_camera().items()},
            "joints": [
                {"joint": joint, **found.to_json()} for joint, found in zip(HAND_JOINTS, self.by_joint(), strict=True)
            ],
            "items": [self.describe_item(item) for item in range(len(self.frame))],
            "worst": [self.describe_item(item) for item in self.worst_items()],
            "annotated": len(self.frame) + len(self.untracked),
            "evaluated": int(self.is_judged.sum()),
            "sources": self.count_sources(),
            "left_out_joints": int(self.left_out.sum()),
            "untracked": [{"frame": f, "camera": c, "hand": h} for f, c, h in self.untracked],
        }

    def describe_item(self, item: int) -> dict[str, Any]:
        """One item in plain values, px."""
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


def _is(names: tuple[str, ...], wanted: str) -> npt.NDArray[np.bool_]:
    return np.array([name == wanted for name in names], dtype=bool)[:, None]


def evaluate_track(track: Track, annotations: Annotations, sources: Sequence[str] = JUDGING) -> Evaluation:
    """Errors of a track at every annotated hand that it holds, by the joints that came from one of `sources`."""
    places = {int(frame): place for place, frame in enumerate(track.frame)}
    cameras = {camera: c for c, camera in enumerate(track.camera_ids)}
    columns = {name: j for j, name in enumerate(track.joint_names)}

    def is_tracked(item: Annotation) -> bool:
        return item.frame in places and item.camera in cameras and f"{item.hand}/{HAND_JOINTS[0]}" in columns

    evaluated = [item for item in annotations.items if is_tracked(item)]
    shape = (len(evaluated), len(HAND_JOINTS))
    marked = np.array([item.points for item in evaluated], dtype=np.float64).reshape(*shape, 3)
    visibility = marked[..., 2].astype(np.int64)
    tracked = np.empty((*shape, 2))
    for row, item in enumerate(evaluated):
        own = [columns[f"{item.hand}/{joint}"] for joint in HAND_JOINTS]
        tracked[row] = track.joints_2d[places[item.frame], cameras[item.camera], own]
    distance = np.linalg.norm(tracked - marked[..., :2], axis=-1)
    everything = Evaluation(
        frame=np.array([item.frame for item in evaluated], dtype=np.int64),
        camera=tuple(item.camera for item in evaluated),
        hand=tuple(item.hand for item in evaluated),
        status=tuple(str(track.status[places[item.frame]]) for item in evaluated),
        error=np.where(visibility > 0, distance, np.nan),
        visibility=visibility,
        marked=marked[..., :2],
        tracked=tracked,
        untracked=tuple(item.key for item in annotations.items if not is_tracked(item)),
        track_frame=np.asarray(track.frame, dtype=np.int64),
        lost_frame=np.asarray(track.frame, dtype=np.int64)[track.status == "lost"],
        sources=tuple(item.sources for item in evaluated),
        left_out=np.zeros(shape, dtype=bool),
    )
    return everything.select(sources=sources)

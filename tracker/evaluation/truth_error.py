"""A track against the exact truth of a synthetic recording."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tracker.capture.truth import Truth
from tracker.errors import TrackerError
from tracker.evaluation.statistics import Statistics, compute_statistics
from tracker.model.joints import HAND_JOINTS

if TYPE_CHECKING:
    from tracker.tracking.track import Track

Array = npt.NDArray[np.float64]

LOST = 0.040
"""A hand whose joints are further off than this on average is lost, m."""


@dataclass(frozen=True)
class TruthError:
    """Errors of a track at T frames and H hands, exactly known.

    Attributes:
        frame: (T,) frames that both the track and the truth hold.
        status: T, what the tracker said of each.
        hands: H names.
        error: (T, H, 21) distance of each joint to the truth, m.
        error_px: (T, C, H, 21) the same in the images, px; NaN where a joint does not project.
    """

    frame: npt.NDArray[np.int64]
    status: tuple[str, ...]
    hands: tuple[str, ...]
    error: Array
    error_px: Array

    def __post_init__(self) -> None:
        assert self.error.shape == (len(self.frame), len(self.hands), len(HAND_JOINTS))
        assert len(self.status) == len(self.frame)

    @property
    def hand_mean(self) -> Array:
        """(T, H) mean over the joints of a hand, m."""
        return self.error.mean(axis=2)

    @property
    def statistics_mm(self) -> Statistics:
        return compute_statistics(1e3 * self.error)

    @property
    def is_lost(self) -> npt.NDArray[np.bool_]:
        """(T,) whether any hand is further off than `LOST` (or nowhere)."""
        return ~np.all(self.hand_mean <= LOST, axis=1)

    @property
    def is_silently_lost(self) -> npt.NDArray[np.bool_]:
        """(T,) lost, and the tracker did not say so."""
        return self.is_lost & np.array([status != "lost" for status in self.status], dtype=bool)

    def to_json(self) -> dict[str, Any]:
        mean_mm = 1e3 * self.hand_mean
        worst = np.argsort(-mean_mm.max(axis=1), kind="stable")[:10] if mean_mm.size else np.zeros(0, dtype=np.int64)
        return {
            "joint_error_mm": self.statistics_mm.to_json(),
            "joint_error_px": compute_statistics(self.error_px).to_json(),
            "worst_frame_mm": float(mean_mm.max()) if mean_mm.size else None,
            "hands": {
                hand: compute_statistics(1e3 * self.error[:, number]).to_json()
                for number, hand in enumerate(self.hands)
            },
            "joints": [
                {"joint": f"{hand}/{joint}", **compute_statistics(1e3 * self.error[:, h, j]).to_json()}
                for h, hand in enumerate(self.hands)
                for j, joint in enumerate(HAND_JOINTS)
            ],
            "frames": len(self.frame),
            "lost": [int(frame) for frame in self.frame[self.is_lost]],
            "silently_lost": [int(frame) for frame in self.frame[self.is_silently_lost]],
            "worst": [
                {"frame": int(self.frame[t]), "status": self.status[t], "mean_mm": float(mean_mm[t].max())}
                for t in worst
            ],
        }


def evaluate_against_truth(track: Track, truth: Truth) -> TruthError:
    """Errors of a track at every frame of the truth that it holds, for every hand of the truth.

    Raises:
        TrackerError: They have no frame in common, or the track misses a hand that the truth has.
    """
    hands = tuple(name.removesuffix("/wrist") for name in truth.joint_names if name.endswith("/wrist"))
    names = [f"{hand}/{joint}" for hand in hands for joint in HAND_JOINTS]
    missing = sorted({name.split("/")[0] for name in names if name not in track.joint_names})
    if not hands or missing:
        tracked = sorted({name.split("/")[0] for name in track.joint_names if "/" in name})
        raise TrackerError(
            f"The truth has the hands {list(hands)}, the track {tracked}; they must have them in common."
        )
    frames, in_track, in_truth = np.intersect1d(track.frame, truth.frame, return_indices=True)
    if len(frames) == 0:
        raise TrackerError("The track and the truth have no frame in common; are they of the same recording?")
    if track.joints_2d.shape[1] != truth.joints_2d.shape[1]:
        raise TrackerError(
            f"The track has {track.joints_2d.shape[1]} cameras and the truth {truth.joints_2d.shape[1]}; "
            "are they of the same recording?"
        )
    own = [list(track.joint_names).index(name) for name in names]
    true = [truth.joint_names.index(name) for name in names]
    shape = (len(frames), len(hands), len(HAND_JOINTS))
    error = np.linalg.norm(track.joints_3d[in_track][:, own] - truth.joints_3d[in_truth][:, true], axis=2)
    error_px = np.linalg.norm(track.joints_2d[in_track][:, :, own] - truth.joints_2d[in_truth][:, :, true], axis=3)
    return TruthError(
        frame=frames.astype(np.int64),
        status=tuple(str(track.status[t]) for t in in_track),
        hands=hands,
        error=error.reshape(shape),
        error_px=error_px.reshape(len(frames), -1, *shape[1:]),
    )

"""What the tracker must remember from frame to frame, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.fitting.setup import TrackSetup
from tracker.geometry import se3
from tracker.landmarks import DetectedHand
from tracker.landmarks.detected_hand import ROW
from tracker.model.scene import Scene
from tracker.tracking.arrays_file import load_arrays, save_arrays
from tracker.tracking.patience import Patience

Array = npt.NDArray[np.float64]

PATIENCE = ("second_try", "tips")
"""When a try that failed may be repeated; a state that was stored before one of them was kept tries at once."""


@dataclass(frozen=True)
class TrackState:
    """The state after a frame. Saved and loaded it goes on exactly as if it had never left memory.

    Attributes:
        next_frame: Frame to track next.
        pose: (D,) of the last frame.
        earlier_pose: (D,) of the frame before; equal to `pose` where there is none.
        is_lost: Whether a hand was nowhere in the last frame.
        lost_hands: Which, indices of the scene's models; none though one is lost means all.
        second_try: When there is another second try after one that failed.
        tips: When a finger may be taken to a tip that shows again.
        detected: Hands that the detector saw in the last frame, by name.
    """

    next_frame: int
    pose: Array
    earlier_pose: Array
    is_lost: bool = False
    second_try: Patience = field(default_factory=Patience)
    tips: Patience = field(default_factory=Patience)
    lost_hands: tuple[int, ...] = ()
    detected: Mapping[str, DetectedHand] = field(default_factory=dict)

    def gone_hands(self, setup: TrackSetup) -> tuple[int, ...]:
        """Indices of the hands that were nowhere in the last frame."""
        if not self.is_lost:
            return ()
        return self.lost_hands or setup.hands

    def predict(self, scene: Scene, bends: bool = False) -> Array:
        """(D,) the pose if roots go on as they moved last; joint angles are kept, or go on within their limits.

        Hidden fingers run away when their angles are extrapolated, roots do not: only where many views leave hardly a
        finger hidden do angles go on (`bends`). The root of a chain is its end: it
        turns as the chain bends, and its turn would swing the other end aside. Chains start where they are.
        """
        predicted = self.pose.copy()
        bent = {int(place) for place in scene.bends.ravel()}
        for where in scene.pose_slices:
            if bent.intersection(range(where.start, where.stop)):
                continue
            root = slice(where.start, where.start + 6)
            T_now, T_before = se3.exp(self.pose[root]), se3.exp(self.earlier_pose[root])
            predicted[root] = se3.log(T_now @ se3.inverse(T_before) @ T_now)
            if bends:
                own = slice(where.start + 6, where.stop)
                further = 2.0 * self.pose[own] - self.earlier_pose[own]
                predicted[own] = np.clip(further, scene.lower[own], scene.upper[own])
        return predicted

    @property
    def _patience(self) -> dict[str, Patience]:
        return {name: getattr(self, name) for name in PATIENCE}

    def save(self, path: Path) -> None:
        """Write to an npz file, whole or not at all."""
        save_arrays(
            path,
            {
                "next_frame": np.array(self.next_frame),
                "pose": self.pose,
                "earlier_pose": self.earlier_pose,
                "is_lost": np.array(self.is_lost),
                **{name: np.array([patience.wait, patience.last]) for name, patience in self._patience.items()},
                "lost_hands": np.array(self.lost_hands, dtype=np.int64),
                "detected_names": np.array(list(self.detected), dtype=np.str_),
                "detected": np.array([hand.to_row() for hand in self.detected.values()]).reshape(-1, ROW),
            },
        )

    @classmethod
    def load(cls, path: Path) -> TrackState:
        """Read what `save` wrote."""
        names = ("next_frame", "pose", "earlier_pose", "is_lost")
        arrays = load_arrays(path, names, optional=(*PATIENCE, "lost_hands", "detected_names", "detected"))
        return cls(
            int(arrays["next_frame"]),
            arrays["pose"],
            arrays["earlier_pose"],
            bool(arrays["is_lost"]),
            lost_hands=tuple(int(hand) for hand in arrays.get("lost_hands", ())),
            detected={
                str(name): DetectedHand.from_row(row)
                for name, row in zip(arrays.get("detected_names", ()), arrays.get("detected", ()), strict=True)
            },
            **{name: Patience(*(int(frames) for frames in arrays[name])) for name in PATIENCE if name in arrays},
        )

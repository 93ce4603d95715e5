"""What tracking one frame gave."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.fitting.quality import Quality
from tracker.tracking.watch_objects import WatchedObject

STATUSES = ("ok", "lost", "recovered")


@dataclass(frozen=True)
class FrameResult:
    """One tracked frame.

    Attributes:
        frame: Its number.
        pose: (D,); of a lost frame, the last pose before.
        status: One of STATUSES.
        seconds: From the decoded frame to the pose.
        quality: How well the pose explains the frame; None where there was nothing to compare with.
        costs: One per iteration, cost of each term, mm².
        stages: Seconds by stage, "reading" among them though not in `seconds`.
        objects: What became of each object, in the order of `TrackSetup.object_names`.
        hand_status: One of STATUSES for each hand, in the order of `TrackSetup.hand_names`; `status` is the worst.
        seen: (C, H, 21, 2) where the detector saw each hand's joints in each of `TrackSetup.view_ids`, px as recorded;
            NaN where it saw none.
    """

    frame: int
    pose: npt.NDArray[np.float64]
    status: str
    seconds: float
    quality: Quality | None
    costs: tuple[dict[str, float], ...]
    stages: dict[str, float]
    objects: tuple[WatchedObject, ...] = ()
    hand_status: tuple[str, ...] = ()
    seen: npt.NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0, 21, 2), dtype=np.float32))

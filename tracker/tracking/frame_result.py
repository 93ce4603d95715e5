"""What tracking one frame gave."""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.fitting.attempt import Attempt
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

    @classmethod
    def of(
        cls,
        frame: int,
        pose: npt.NDArray[np.float64],
        hand_status: tuple[str, ...],
        seconds: float,
        attempt: Attempt | None,
        stages: dict[str, float],
        objects: list[WatchedObject],
    ) -> FrameResult:
        """Of a frame with depth, in which `attempt` was fitted; None where nothing was in sight."""
        quality = attempt.quality if attempt is not None and attempt.qualities else None
        costs = () if attempt is None else attempt.fit.costs
        status = sum_up(hand_status)
        return cls(frame, pose, status, seconds, quality, costs, stages, tuple(objects), hand_status)


def sum_up(hand_status: tuple[str, ...]) -> str:
    """Status of a frame: of the hand that is worst off."""
    return next((status for status in ("lost", "recovered") if status in hand_status), "ok")


def tell_statuses(hands: Iterable[int], lost: Container[int], found: Container[int]) -> tuple[str, ...]:
    """Status of each hand, by which of them are lost and which were found again."""
    return tuple("lost" if hand in lost else "recovered" if hand in found else "ok" for hand in hands)

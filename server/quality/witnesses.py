"""What a track and the hand detector say of a whole recording, as the checks read it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from server.quality.views import Marks


@dataclass(frozen=True)
class TrackedHands:
    """The hands of a track.

    Attributes:
        joints: (21, 2) px by camera, frame and hand, where it held them.
        lost: Frames and hands that it lost.
        depth_mm: How far the hands of a frame are from the depth, where there is any.
    """

    joints: Marks = field(default_factory=dict)
    lost: frozenset[tuple[int, str]] = frozenset()
    depth_mm: dict[int, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Detections:
    """The hands that the detector found.

    Attributes:
        joints: (21, 2) px by camera, frame and hand; NaN where a joint is outside the image.
        frames: That it looked at, in all cameras it was asked to look at.
    """

    joints: Marks = field(default_factory=dict)
    frames: range = range(0)


def read_track(folder: Path) -> TrackedHands:
    """From a track's folder; the models in it are not needed."""
    with np.load(folder / "track.npz", allow_pickle=False) as arrays:
        frames, status = arrays["frame"].tolist(), arrays["status"].tolist()
        of_hands = {
            str(hand): arrays["hand_status"][:, column].tolist()
            for column, hand in enumerate(arrays["hand_names"].tolist() if "hand_status" in arrays else [])
        }
        cameras = [str(name) for name in arrays["camera_ids"]]
        names = [str(name) for name in arrays["joint_names"]]
        points = arrays["joints_2d"].astype(np.float64)
    joints, lost = {}, set()
    for hand in ("right", "left"):
        columns = [place for place, name in enumerate(names) if name.startswith(f"{hand}/")]
        if len(columns) != 21:
            continue
        for row, frame in enumerate(frames):
            if of_hands.get(hand, status)[row] == "lost":
                lost.add((frame, hand))
                continue
            for index, camera in enumerate(cameras):
                joints[camera, frame, hand] = points[row, index, columns]
    return TrackedHands(joints, frozenset(lost), _read_depth(folder, frames))


def _read_depth(folder: Path, frames: list[int]) -> dict[int, float]:
    """How far the hands of each frame are from the depth, mm; nothing of frames without depth."""
    if not (folder / "frames.npz").is_file():
        return {}
    with np.load(folder / "frames.npz", allow_pickle=False) as arrays:
        apart = arrays["depth_residual_mm"].tolist() if "depth_residual_mm" in arrays else []
    return {frame: value for frame, value in zip(frames, apart, strict=False) if np.isfinite(value)}


def read_detections(path: Path) -> Detections:
    """From the file of a job that looked through the whole recording."""
    from tracker.detection import load_recorded_hands

    found = load_recorded_hands(path)
    return Detections(
        {
            (item.camera, item.frame, item.hand): np.where(item.points[:, 2:] > 0, item.points[:, :2], np.nan)
            for item in found.hands.items
        },
        found.frames,
    )

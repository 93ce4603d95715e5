"""Tracks with errors that are known by hand."""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.evaluation.comparison import JudgedTrack
from tracker.evaluation.evaluation import Evaluation


def make_evaluation(error: np.ndarray, frames: list[int] | None = None, **changes: Any) -> Evaluation:
    """One right hand in each frame, seen by cam0; the marks lie at (10 j, 20), the track `error` px right of them."""
    items = len(error)
    marked = np.stack([np.tile(10.0 * np.arange(21), (items, 1)), np.full((items, 21), 20.0)], axis=2)
    tracked = marked + np.stack([error, np.zeros_like(error)], axis=2)
    values = {
        "frame": np.array(frames if frames is not None else range(items), dtype=np.int64),
        "camera": ("cam0",) * items,
        "hand": ("right",) * items,
        "status": ("ok",) * items,
        "error": error,
        "visibility": np.full((items, 21), 2, dtype=np.int64),
        "marked": marked,
        "tracked": tracked,
        "untracked": (),
        "track_frame": np.arange(max(items, 1), dtype=np.int64),
        "lost_frame": np.zeros(0, dtype=np.int64),
        "sources": (None,) * items,
        "left_out": np.zeros((items, 21), dtype=bool),
    }
    return Evaluation(**(values | changes))


def judge(key: str, evaluation: Evaluation, recording: str = "waving", **parameters: Any) -> JudgedTrack:
    """A track of that name with these errors."""
    return JudgedTrack(key, f"Track {key}", recording, recording, parameters, evaluation, {"revision": 7})

"""A blend model whose every part does something, made from the untrained hand and random numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.model.blend_model import BlendModel
from tracker.model.untrained_hand import untrained_hand


def random_blend(seed: int = 0, num_shape: int = 10, side: str = "right") -> BlendModel:
    """Pose blend shapes of some millimetres for each vertex, dense, and a pose space of 45 components."""
    rng = np.random.default_rng(seed)
    hand = untrained_hand(side)
    return replace(
        hand,
        shape_directions=np.ascontiguousarray(hand.shape_directions[:, :, :num_shape]),
        pose_directions=0.002 * rng.standard_normal(hand.pose_directions.shape),
        pose_mean=0.2 * rng.standard_normal(45),
        pose_components=np.linalg.qr(rng.standard_normal((45, 45)))[0],
    )


def random_pose(model: BlendModel, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pose, shape and translation of an ordinary size."""
    rng = np.random.default_rng(seed)
    return 0.5 * rng.standard_normal((model.num_bones, 3)), rng.standard_normal(model.num_shape), rng.standard_normal(3)

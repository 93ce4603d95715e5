"""Compile, or load from the cache, the kernels of training before somebody waits for them."""

from __future__ import annotations

import numpy as np

from tracker.model.untrained_hand import untrained_hand
from tracker.training.options import TrainingOptions
from tracker.training.train import train_model
from tracker.training.training_set import TrainingSet

SUBJECTS, POSES = 4, 6
"""Of a set that is only there to compile the kernels: so small, and yet every stage runs."""


def warm_up_training() -> None:
    """Learn from a few hands that the untrained model made itself."""
    model = untrained_hand()
    rng = np.random.default_rng(1)
    shapes = rng.normal(size=(SUBJECTS, model.num_shape))
    poses = rng.normal(scale=0.2, size=(POSES, model.num_bones, 3))
    poses[0] = 0.0
    vertices = np.array([model.pose_at(pose, shape).vertices for shape in shapes for pose in poses])
    subjects = np.repeat([f"person {number}" for number in range(SUBJECTS)], POSES)
    names = np.tile([f"pose {number}" for number in range(POSES)], SUBJECTS)
    train_model(
        TrainingSet(vertices, subjects, names, np.zeros(len(vertices), dtype=bool)),
        model,
        TrainingOptions(rounds=1, ridge=1e-3),
    )

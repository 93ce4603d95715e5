"""What a training was made from and how well the model fits it, as JSON."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.training.learn import Learnt
from tracker.training.options import TrainingOptions
from tracker.training.spaces import Space
from tracker.training.training_set import TrainingSet


def describe_training(
    used: TrainingSet,
    owners: npt.NDArray[np.int64],
    left_out: dict[str, int],
    learnt: Learnt,
    shape_space: Space,
    pose_space: Space,
    errors: list[float],
    options: TrainingOptions,
    seconds: dict[str, float],
) -> dict[str, Any]:
    """The report of a training.

    Args:
        used: The N registrations that were learnt from; owners (N,) whose.
        left_out: Hands with too few registrations, and how many.
        learnt: The result.
        errors: Root mean square distance to the registrations after each round, m.
        seconds: By stage.
    """
    residuals = 1e3 * learnt.poses.errors
    hands = used.hands
    away = np.linalg.norm(np.stack([learnt.regressor @ own for own in learnt.templates]) - learnt.joints, axis=2)
    worst = np.argsort(-residuals, kind="stable")[:10]
    return {
        "registrations": len(used),
        "people": len(np.unique(used.subjects)),
        "hands": len(learnt.templates),
        "left_out": left_out,
        "residual_mm": round(float(np.sqrt(np.mean(residuals**2))), 4),
        "rounds_mm": [round(1e3 * error, 4) for error in errors],
        "by_hand": _group(hands, residuals),
        "by_pose": _group(used.pose_names, residuals),
        "worst": [
            {"hand": str(hands[n]), "pose": str(used.pose_names[n]), "residual_mm": round(float(residuals[n]), 4)}
            for n in worst
        ],
        "vertices_per_joint": round(learnt.regressor.nnz / learnt.joints.shape[1], 1),
        "joint_regressor_mm": round(1e3 * float(away.mean()), 4),
        "shape_space": [round(float(share), 5) for share in shape_space.explained],
        "pose_space": [round(float(share), 5) for share in pose_space.explained],
        "options": options.describe(),
        "seconds": seconds,
    }


def _group(names: npt.NDArray, residuals: npt.NDArray) -> dict[str, dict[str, float]]:
    """Root mean square residual by name, mm."""
    return {
        str(name): {
            "registrations": int((names == name).sum()),
            "residual_mm": round(float(np.sqrt(np.mean(residuals[names == name] ** 2))), 4),
        }
        for name in np.unique(names)
    }

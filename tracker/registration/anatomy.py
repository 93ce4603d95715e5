"""What anatomy says of a pose before the scan is seen: a prior for any hand in MANO's order of joints."""

from __future__ import annotations

import numpy as np

from tracker.model.blend_limits import BlendLimits, blend_limits
from tracker.model.blend_model import BlendModel
from tracker.registration.pose_prior import PosePrior


def make_anatomical_prior(model: BlendModel, limits: BlendLimits | None = None) -> PosePrior:
    """Wide in flexion, narrow in abduction and twist, and soft limits of all three: the first prior of [R17] Eq. 8.

    Differs from the paper: E_θ = |θ|² twists the fingers of ball joints, so every axis has its own deviation.

    Args:
        model: A hand with MANO's joints.
        limits: Its own, where they are known already.
    """
    limits = limits or blend_limits(model)
    count = 3 * len(limits.axes)
    rows = np.zeros((count, count))
    for bone, axes in enumerate(limits.axes):
        place = slice(3 * bone, 3 * bone + 3)
        rows[place, place] = axes
    return PosePrior(
        mean=limits.pose_at(limits.mean)[1:].ravel(),
        root=rows / limits.deviation.ravel()[:, None],
        axes=rows,
        low=limits.lower.ravel(),
        high=limits.upper.ravel(),
    )

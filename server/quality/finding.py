"""What a check says of a label."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from server.quality.labels import Label

Kind = Literal["outside", "finger_order", "handedness", "jump", "bone_length", "depth", "reprojection", "residual"]


@dataclass(frozen=True)
class Finding:
    """Something about a label that looks wrong."""

    label: Label
    kind: Kind
    score: float
    joints: tuple[int, ...]
    reason: str

"""What a check says of a label, and which labels it could look at."""

from __future__ import annotations

import uuid
from collections import defaultdict
from dataclasses import dataclass
from typing import Literal, get_args

from server.quality.labels import Label

Kind = Literal[
    "outside",
    "finger_order",
    "handedness",
    "jump",
    "bone_length",
    "depth",
    "background",
    "reprojection",
    "residual",
    "detector",
]
KINDS: tuple[Kind, ...] = get_args(Kind)


@dataclass(frozen=True)
class Finding:
    """Something about a label that looks wrong."""

    label: Label
    kind: Kind
    score: float
    joints: tuple[int, ...]
    reason: str


class Looked:
    """Which labels each check had something to go by for."""

    def __init__(self) -> None:
        self._labels: dict[Kind, set[uuid.UUID]] = defaultdict(set)

    def at(self, kind: Kind, label: Label) -> None:
        """The check of this kind looked at the label."""
        self._labels[kind].add(label.id)

    def find(self, kind: Kind) -> frozenset[uuid.UUID]:
        """The labels that the check looked at."""
        return frozenset(self._labels[kind])

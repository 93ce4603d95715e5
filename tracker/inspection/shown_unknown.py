"""What a run left out as neither hand nor model: held things without a model, sleeves, what hides the hand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.fitting.measure_quality import ALIKE
from tracker.observation import HAND, OTHER, Observation
from tracker.rendering import View


@dataclass(frozen=True)
class ShownUnknown:
    """Pixels of the region that a run looked at.

    Attributes:
        mask: (H, W) bool, pixels of the depth camera's image: something is seen there that is no hand by its colour, or
            stands before the hand as it was fitted, and that no model explains.
        points: (N, 3) float32 world, m, of the mask row by row.
        before: How many of them hide the hand.
        by_color: Whether colour told the hand from other things; otherwise only what hides the hand is known.
    """

    mask: npt.NDArray[np.bool_]
    points: npt.NDArray[np.float32]
    before: int
    by_color: bool

    @classmethod
    def nothing(cls, height: int, width: int) -> ShownUnknown:
        """Where the models are out of sight."""
        return cls(np.zeros((height, width), dtype=bool), np.zeros((0, 3), dtype=np.float32), 0, False)


def show_unknown(view: View, seen: Observation, height: int, width: int) -> ShownUnknown:
    """Mark what the terms and the judgement of a fit leave out of account.

    Args:
        view: The scene, drawn.
        seen: The frame, every pixel of a region of it.
        height, width: Of the whole image, px.
    """
    scene, labels = view.posed.scene, seen.labels
    is_drawn, depth = view.face >= 0, view.depth
    hands = np.array([model.hand is not None for model in scene.models])
    on_hand = is_drawn & hands[scene.face_models[np.maximum(view.face, 0)]]
    by_object = is_drawn & ~on_hand & (np.abs(seen.depth - depth) < ALIKE)
    is_other = (labels == OTHER) & ~by_object
    nearer = (labels == HAND | OTHER) & (seen.depth < depth - ALIKE)
    before = on_hand & (nearer | (is_other & (seen.depth < depth + ALIKE)))
    own = before | is_other
    mask = np.zeros((height, width), dtype=bool)
    rows = slice(seen.region.row, seen.region.row + seen.region.height)
    mask[rows, seen.region.column : seen.region.column + seen.region.width] = own
    by_color = bool(np.any((labels == HAND) | (labels == OTHER)))
    return ShownUnknown(mask, seen.points[own], int(np.count_nonzero(before)), by_color)

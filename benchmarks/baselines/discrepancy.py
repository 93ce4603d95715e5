"""What the swarm minimises: how far a drawn pose is from what was seen."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from benchmarks.baselines.drawing import Canvas, Drawing
from benchmarks.baselines.moved_scene import MovedScene
from tracker.fitting.frame_fit import label_scene
from tracker.model.scene import Scene
from tracker.observation import Observation

Array = npt.NDArray[np.float64]

CUT = 40.0
"""Depth differences count no more than this, mm: d_M of [O11]."""

ALIKE = 10.0
"""Drawn and seen depth within this match, mm: d_m of [O11]."""

SILHOUETTE_WEIGHT = 20.0
"""λ of [O11], mm."""


class Discrepancy:
    """Cost of a pose against one thinned observation.

    E = Σ min(|o − r|, d_M) / |s ∪ m| + λ (1 − 2 |s ∩ m| / (|s ∩ m| + |s ∪ m|))

    o seen and r drawn depth, mm; s pixels whose label some model may have; m drawn pixels that match: depth within d_m
    and a label of the model drawn there. The sum runs over s and over drawn pixels; where only one of both is, or the
    label is another's, the difference counts as d_M. [O11] Eq. 2.

    Differs from the paper: a drawn pixel without depth does not match, for what lies behind the hand is cut away here
    as if it had none; a drawn pixel hidden by something nearer that no model claims counts neither way; the penalty of
    neighbouring fingers that cross is left to the joint limits.
    """

    def __init__(self, scene: Scene, observation: Observation) -> None:
        self.observation = observation
        self.face_bits = label_scene(scene)[1]
        self.bits = int(np.bitwise_or.reduce(self.face_bits))
        self.moved = MovedScene(scene)
        height, width = observation.labels.shape
        self.drawing = Drawing(scene, (Canvas(observation.K, observation.T_world_camera, (height, width)),))

    def __call__(self, pose: Array) -> float:
        """Cost of the pose (D,), mm; 60 for a pose that matches nothing."""
        drawing, seen = self.drawing, self.observation
        drawing.draw(self.moved.move(pose))
        return compare(drawing.inverse_depth, drawing.face, self.face_bits, seen.depth, seen.labels, self.bits)


@njit(cache=True, nogil=True)
def compare(
    inverse_depth: Array,
    face: npt.NDArray[np.int32],
    face_bits: npt.NDArray[np.uint8],
    depth: npt.NDArray[np.float32],
    labels: npt.NDArray[np.uint8],
    bits: int,
) -> float:
    """The cost of a drawing, mm.

    Args:
        inverse_depth: (H, W) drawn, 1/m.
        face: (H, W) drawn face, -1 where none is.
        face_bits: (F,) label bits that may be seen where a face is drawn.
        depth: (H, W) seen, m.
        labels: (H, W) seen.
        bits: Label bits of all models.
    """
    total = 0.0
    both, either = 0, 0
    height, width = labels.shape
    for row in range(height):
        for column in range(width):
            f = face[row, column]
            label = labels[row, column]
            is_seen = label & bits != 0
            if f < 0 and not is_seen:
                continue
            difference = CUT
            is_match = False
            if f >= 0:
                signed = 1000.0 * (depth[row, column] - 1.0 / inverse_depth[row, column])
                if label & face_bits[f] != 0:
                    difference = min(abs(signed), CUT)
                    is_match = abs(signed) < ALIKE
                elif label != 0 and not is_seen and signed < -ALIKE:
                    continue
            total += difference
            if is_match:
                both += 1
            either += 1
    if either == 0:
        return CUT + SILHOUETTE_WEIGHT
    return total / either + SILHOUETTE_WEIGHT * (1.0 - 2.0 * both / (both + either))

"""A Hough forest: trees whose leaves say how likely a patch belongs to a fingertip, or a nail, and where that lies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

MODES = 3
"""Votes that a leaf keeps."""

WHATS = ("fingertips", "nails")

NODE_FIELDS = ("channel", "first", "second", "threshold", "child")
"""Of a node; `first` and `second` are places in a patch, row * PATCH + column.

A patch goes to the node `child + 1` of its tree if channel[first] - channel[second] > threshold, else to `child`. At a
leaf the channel is -1 and `child` the number of the leaf in its tree.
"""


@dataclass(frozen=True)
class Forest:
    """[T16] §3.2.5 after J. Gall et al., "Hough forests for object detection, tracking, and action recognition", 2011.

    Attributes:
        kind: "depth" or "color", what it looks at.
        pixel_size: Width of a pixel of a patch, m.
        box_size: Side of a detection's box, m.
        confidence_scale: Confidence per unit of the vote density; chosen so that c_thr = 3.0, [T16] §3.2.5, is a
            sensible threshold (`calibrate_confidence`).
        nodes: (N, 5) int16 NODE_FIELDS.
        node_starts: (T + 1,) int32 first node of each tree.
        leaf_starts: (T + 1,) int32 first leaf of each tree.
        probability: (L,) float32 share of fingertip patches in a leaf, fingertips and others counted as equally many.
        votes: (L, MODES, 4) float32: column, row and depth from the patch's centre to the fingertip, px of a patch, and
            the vote's share; shares sum to one over the modes, or to zero in a leaf without fingertips.
        what: "fingertips" or "nails", what it finds.
    """

    kind: str
    pixel_size: float
    box_size: float
    confidence_scale: float
    nodes: npt.NDArray[np.int16]
    node_starts: npt.NDArray[np.int32]
    leaf_starts: npt.NDArray[np.int32]
    probability: npt.NDArray[np.float32]
    votes: npt.NDArray[np.float32]
    what: str = "fingertips"

    def __post_init__(self) -> None:
        assert self.kind in ("depth", "color") and self.what in WHATS
        assert self.nodes.dtype == np.int16 and self.nodes.shape == (self.node_starts[-1], len(NODE_FIELDS))
        assert self.probability.shape == (self.leaf_starts[-1],)
        assert self.votes.shape == (self.leaf_starts[-1], MODES, 4)

    @property
    def num_trees(self) -> int:
        return len(self.node_starts) - 1

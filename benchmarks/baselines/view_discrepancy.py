"""What the swarm minimises before several colour cameras: how far a drawn pose is from what the images show."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from numba import njit

from benchmarks.baselines.discrepancy import ALIKE, CUT, SILHOUETTE_WEIGHT
from benchmarks.baselines.drawing import Drawing
from benchmarks.baselines.joint_rays import JointRays
from benchmarks.baselines.moved_scene import MovedScene
from benchmarks.baselines.skin_view import SkinView
from tracker.model.scene import Scene

Array = npt.NDArray[np.float64]


class ViewDiscrepancy:
    """Cost of a pose against the colour images of one moment and the joints detected in them.

    E = mean over views of [ λ (1 − 2 |s ∩ m| / (|s ∩ m| + |s ∪ m|)) + mean of min(d, d_M) ] + mean of min(j, d_M)

    s pixels of skin and m pixels where a hand is drawn, in front of whatever else is; d how far an edge of the drawing
    is from the nearest edge of the image, j how far a joint is from the viewing ray it was detected on, both mm. The
    first two are those of [O11b] (Oikonomidis et al. 2011, ICCV), the third is the S that [T16] §4.4.1 adds.

    An edge of the drawing lies between two neighbouring pixels of which one is empty, or another model's, or more than
    d_m behind. The two are d = (d1 + d2 - step) / 2 from an edge, 0 where an edge runs anywhere between them.

    Differs from the papers: λ and d_M are those of depth images; collision and flow, which [T16] counts too, and the
    penalty of [O11b] for what intersects are left out: nothing but the joint limits keeps a pose from those.
    """

    def __init__(self, scene: Scene, views: Sequence[SkinView], joints: JointRays) -> None:
        assert views, "at least one view"
        self.views, self.joints = views, joints
        self.face_models = scene.face_models
        self.is_hand = np.array([model.hand is not None for model in scene.models])
        self.moved = MovedScene(scene)
        self.drawing = Drawing(scene, tuple(view.canvas for view in views))

    def __call__(self, pose: Array) -> float:
        """Cost of the pose (D,), mm."""
        vertices, drawing = self.moved.move(pose), self.drawing
        total = 0.0
        for number, view in enumerate(self.views):
            drawing.draw(vertices, number)
            drawn = drawing.inverse_depth, drawing.face, self.face_models, self.is_hand
            total += compare_view(drawn, view.is_skin, view.edge_mm, view.step_mm)
        return total / len(self.views) + self.joints.measure(vertices)


@njit(cache=True, nogil=True)
def compare_view(drawn, is_skin: npt.NDArray[np.bool_], edge_mm: npt.NDArray[np.float32], step_mm: float) -> float:
    """The cost of a drawing in one view, mm; 60 where nothing is drawn.

    Args:
        drawn: inverse_depth (H, W) 1/m, face (H, W), face_models (F,) and is_hand (M,), whether a model is one.
        is_skin, edge_mm, step_mm: As in `SkinView`.
    """
    inverse_depth, face, face_models, is_hand = drawn
    height, width = is_skin.shape
    both, either, edges, apart = 0, 0, 0, 0.0
    for row in range(height):
        for column in range(width):
            f = face[row, column]
            is_drawn = f >= 0 and is_hand[face_models[f]]
            if is_drawn and is_skin[row, column]:
                both += 1
            if is_drawn or is_skin[row, column]:
                either += 1
            for down in range(2):
                r, c = row + down, column + 1 - down
                if r >= height or c >= width:
                    continue
                g = face[r, c]
                if f < 0 and g < 0:
                    continue
                is_edge = f < 0 or g < 0 or face_models[f] != face_models[g]
                if not is_edge:
                    here, there = inverse_depth[row, column], inverse_depth[r, c]
                    is_edge = 1000.0 * abs(here - there) > ALIKE * here * there
                if is_edge:
                    beyond = 0.5 * (edge_mm[row, column] + edge_mm[r, c] - step_mm)
                    apart += min(max(beyond, 0.0), CUT)
                    edges += 1
    distance = apart / edges if edges else CUT
    overlap = 2.0 * both / (both + either) if either else 0.0
    return distance + SILHOUETTE_WEIGHT * (1.0 - overlap)

"""How well a fitted object explains what was seen: distinguishes a followed object from a lost one."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numba import njit

from tracker.fitting.measure_quality import ALIKE, CUT
from tracker.observation.observation import OTHER, Observation
from tracker.rendering import View

TOUCHING = 0.010
"""Skin at most this far behind the drawn object still hides it: hands touch what they hold, m."""

RIM = 0.012
"""Other pixels this near to the object's outline, and near in depth, should have been explained by it, m."""

RIM_DEPTH = 0.030
"""m."""

FEW = 40
"""With fewer pixels in sight nothing can be said of an object."""


@dataclass(frozen=True)
class ObjectQuality:
    """Agreement of a drawn object with the pixels that are no hand (without colour, with any).

    Attributes:
        visible: Drawn pixels that nothing nearer hides.
        inside: Share of them whose depth agrees with a pixel that may be an object.
        depth_residual: Median |drawn − seen| where both are, m; infinite where they never meet.
        outline_iou: Drawn and seen pixels there and in a rim around: intersection over union.
        score: 0 to 1, to compare poses by: one minus the mean over that union of |drawn − seen| cut off at 20 mm, in
            units of the cut; a pixel that is only drawn or only seen counts as cut off.
    """

    visible: int
    inside: float
    depth_residual: float
    outline_iou: float
    score: float

    @classmethod
    def of_nothing(cls) -> ObjectQuality:
        """Of an object that is nowhere in the image."""
        return cls(0, 0.0, float("inf"), 0.0, 0.0)

    @property
    def is_hidden(self) -> bool:
        """Whether too little is in sight to say anything."""
        return self.visible < FEW

    @property
    def is_lost(self) -> bool:
        """Whether no one should believe this pose, by what is in sight of it."""
        return not self.is_hidden and (self.inside < 0.6 or self.score < 0.35 or self.depth_residual > 0.012)

    @property
    def status(self) -> str:
        """`ok`, `lost` or `hidden`."""
        return "lost" if self.is_lost else "hidden" if self.is_hidden else "ok"


def measure_object_quality(view: View, observation: Observation, model: int) -> ObjectQuality:
    """Compare one object (its index in the drawn scene) with the observation.

    Differs from a hand's measure: an object has no arm that goes on, and other things stand around it, so of what is
    seen and not drawn only a rim around the outline counts.
    """
    scene = view.posed.scene
    own = np.zeros_like(view.inverse_depth, dtype=np.float32)
    is_own = (view.face >= 0) & (scene.face_models == model)[view.face]
    own[is_own] = view.inverse_depth[is_own]
    if not is_own.any():
        return ObjectQuality.of_nothing()
    pixels = max(1, round(RIM * float(view.K[0, 0]) * float(np.median(own[is_own]))))
    around = cv2.dilate(own, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * pixels + 1, 2 * pixels + 1)))
    counts, residuals = _compare(
        view.inverse_depth, view.face, is_own, np.asarray(around, np.float32), observation.depth, observation.labels
    )
    drawn, alike, both, seen = (float(count) for count in counts)
    union = max(drawn + seen - both, 1.0)
    return ObjectQuality(
        visible=int(drawn),
        inside=alike / max(drawn, 1.0),
        depth_residual=float(np.median(residuals)) if len(residuals) else float("inf"),
        outline_iou=both / union,
        score=1.0 - (float(np.minimum(residuals / CUT, 1.0).sum()) + union - both) / union,
    )


@njit(cache=True, nogil=True)
def _compare(inverse_depth, face, is_own, around, depth, labels):
    """Counts of pixels drawn and in sight, alike, drawn and seen, seen; and |drawn − seen| of those both."""
    height, width = labels.shape
    residuals = np.zeros(height * width)
    drawn = alike = both = seen = 0
    for row in range(height):
        for column in range(width):
            if around[row, column] <= 0.0:
                continue
            label, z_seen = labels[row, column], depth[row, column]
            is_other = label & OTHER != 0
            if is_own[row, column]:
                z = 1.0 / inverse_depth[row, column]
                is_hidden = label != 0 and z_seen < z - ALIKE
                is_hidden = is_hidden or (label != 0 and not is_other and z_seen < z + TOUCHING)
                if is_hidden:
                    continue
                drawn += 1
                if is_other:
                    residuals[both] = abs(z_seen - z)
                    if residuals[both] < ALIKE:
                        alike += 1
                    both += 1
                    seen += 1
            elif is_other:
                is_others = face[row, column] >= 0 and abs(z_seen - 1.0 / inverse_depth[row, column]) < ALIKE
                if not is_others and abs(z_seen - 1.0 / around[row, column]) < RIM_DEPTH:
                    seen += 1
    return (drawn, alike, both, seen), residuals[:both]

"""What a picture of a hand in the queue shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from server.quality.find import Setting
from server.quality.labels import Label
from server.quality.queue import Queued


@dataclass(frozen=True)
class Sight:
    """A hand in one camera.

    Attributes:
        pixels: (21, 2) px; NaN where a joint is not known.
        shows: Whose joints those are: of the label, where there is one, else of the track, else of the detector.
    """

    camera: str
    pixels: npt.NDArray[np.float64]
    shows: str


def find_sight(queued: Queued, labels: Sequence[Label], setting: Setting) -> Sight:
    """In the camera of the worst doubt that is about one, else the first where the hand is known."""
    of_labels = {
        label.camera: label.pixels for label in labels if (label.frame, label.hand) == (queued.frame, queued.hand)
    }
    about = [doubt.camera for doubt in queued.doubts if doubt.camera]
    order = [*about[:1], *setting.cameras]
    for camera in order:
        place = camera, queued.frame, queued.hand
        kinds = (
            ("label", of_labels.get(camera)),
            ("track", setting.tracked.joints.get(place)),
            ("detector", setting.detected.joints.get(place)),
        )
        for shows, pixels in kinds:
            if pixels is not None and np.isfinite(pixels).any():
                return Sight(camera, pixels, shows)
    return Sight(order[0], np.full((21, 2), np.nan), "nothing")

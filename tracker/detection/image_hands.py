"""The hands of a recording in one of its images, as the hand detector sees them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import OCCLUDED, VISIBLE, Annotation
from tracker.capture.frame import Frame
from tracker.capture.joint_source import JointSource
from tracker.detection.hidden_joints import find_hidden_joints
from tracker.landmarks import DetectedHand, HandDetector
from tracker.model.joints import SIDES

DETECTOR_LABEL = "Hand detector"
SOURCE = JointSource("detector", DETECTOR_LABEL)
"""What is noted beside a label that a person makes of a detected joint."""


@dataclass(frozen=True)
class ImageHand:
    """A hand in one image.

    Attributes:
        side: `right` or `left`.
        detected: As the networks tell it.
        is_hidden: (21,) joints that something hides.
    """

    side: str
    detected: DetectedHand
    is_hidden: npt.NDArray[np.bool_]

    @property
    def score(self) -> float:
        """0 to 1, that there is a hand."""
        return self.detected.presence

    def annotate(self, frame: Frame) -> Annotation:
        """As `annotations.json` has it, to the ends of the fingers; joints outside the image are left open."""
        assert frame.color is not None
        height, width = frame.color.shape[:2]
        points = np.column_stack([self.detected.with_finger_ends().points, np.where(self.is_hidden, OCCLUDED, VISIBLE)])
        x, y, _ = points.T
        points[(x < -0.5) | (x >= width - 0.5) | (y < -0.5) | (y >= height - 0.5)] = 0.0
        sources = tuple(SOURCE if v else None for v in points[:, 2])
        return Annotation(frame.index, frame.camera, self.side, np.round(points, 2), sources)


def find_image_hands(
    detector: HandDetector,
    frame: Frame,
    focal: float,
    names: Sequence[str],
    before: Mapping[str, DetectedHand] | None = None,
) -> list[ImageHand]:
    """Look for the hands of a recording in the colour or infrared image of a frame.

    Args:
        detector: Finds hands in images.
        frame: As recorded, with `color`.
        focal: Of its camera, px.
        names: Of the recording's hands, `right` or `left`; both when it names none.
        before: The hands that were found in the frame before, by side; None of an image that is looked at by itself,
            which is turned all ways to find them.
    """
    assert frame.color is not None, "nothing to look at"
    names = tuple(names) or SIDES
    turns = (0, 1, 2, 3) if before is None else (0, 1 + frame.index % 3)
    followed = [before[name] for name in names if name in before] if before else []
    found = detector.find(frame.color, len(names), followed, turns)
    named = name_hands(found, names)
    return [
        ImageHand(name, named[name], find_hidden_joints(named[name], frame, focal)) for name in names if name in named
    ]


def name_hands(found: Sequence[DetectedHand], names: Sequence[str]) -> dict[str, DetectedHand]:
    """Each hand with the name that all sides together make likeliest; the only hand of a recording has its name."""
    if len(names) == 1:
        return {names[0]: found[0]} if found else {}

    def likely(order: tuple[str, ...]) -> float:
        rights = [hand.right if name == "right" else 1.0 - hand.right for hand, name in zip(found, order, strict=True)]
        return float(np.sum(np.log(np.maximum(rights, 1e-6))))

    return dict(zip(max(permutations(names, len(found)), key=likely), found, strict=True))

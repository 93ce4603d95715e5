"""Recordings without images: what the formats need of one is its cameras, its length and its file names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.annotations import Annotation, Annotations
from tracker.capture.frame_pattern import parse_pattern
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence
from tracker.geometry import se3
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.label_set import LabelSet

K = np.array([[500.0, 0.0, 319.5], [0.0, 510.0, 239.5], [0.0, 0.0, 1.0]])
FRAMES = 6
MakeSet = Callable[..., LabelSet]


def make_sequence(cameras: int = 2, hands: tuple[str, ...] = ("right", "left"), distortion: float = 0.0) -> Sequence:
    """Cameras side by side that look at the same place 0.6 m ahead."""
    made = []
    for number in range(cameras):
        angle = 0.5 * number
        T = se3.exp(np.array([0.0, 0.0, 0.0, 0.0, -angle, 0.0]))
        T[:3, 3] = [0.6 * np.sin(angle), 0.0, 0.6 - 0.6 * np.cos(angle)]
        color = parse_pattern(f"cam{number}/color/{{:06d}}.png")
        lens = np.array([distortion, 0.0, 0.0, 0.0])
        made.append(RecordedCamera(f"cam{number}", 640, 480, K, lens if distortion else np.zeros(0), T, color))
    return Sequence(Path("nowhere"), "two hands", 30.0, FRAMES, tuple(made), hands)


@pytest.fixture
def make_set() -> MakeSet:
    def make(items: tuple[Annotation, ...] = (), key: str = "a" * 8, **arguments: object) -> LabelSet:
        sequence = make_sequence(**arguments)  # type: ignore[arg-type]
        return LabelSet(key, sequence, list_image_names(sequence), Annotations(items))

    return make

"""Rendered hands as images to learn fingertips from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.detection.annotated_images import AnnotatedImage
from tracker.detection.patch_image import PatchImage
from tracker.observation import Preprocessing, Region, observe
from tracker.synthesis.random_hands import HandImage, RandomHands, render_random_image

MARGIN = 8
"""Room around the hands, px."""

HAND_ONLY = 0.5
"""Share of images in which only hands are left, as when colour tells them from other things."""


def render_fingertip_images(count: int, seed: int, how: RandomHands | None = None) -> Iterator[AnnotatedImage]:
    """Images of random hands; each depends on the seed and its number only."""
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        rendered = render_random_image(how or RandomHands(), rng)
        found = _cut_out(rendered, number, rng.random() < HAND_ONLY)
        if found is not None:
            yield found


def _cut_out(rendered: HandImage, number: int, hand_only: bool) -> AnnotatedImage | None:
    """The part with hands; None if there is next to nothing of them."""
    has_hand = rendered.is_hand & (rendered.depth > 0.0)
    rows, columns = np.flatnonzero(has_hand.any(axis=1)), np.flatnonzero(has_hand.any(axis=0))
    if np.count_nonzero(has_hand) < 100:
        return None
    top, left = max(0, int(rows[0]) - MARGIN), max(0, int(columns[0]) - MARGIN)
    bottom, right = int(rows[-1]) + MARGIN + 1, int(columns[-1]) + MARGIN + 1
    camera: Camera = rendered.camera
    region = Region(
        top, left, min(bottom, camera.height) - top, min(right, camera.width) - left, 0.05, float(rendered.depth.max())
    )
    depth = np.where(rendered.is_hand, rendered.depth, np.float32(0.0)) if hand_only else rendered.depth
    frame = Frame(number, camera.id, None, depth.astype(np.float32))
    observation = observe(frame, camera, region, Preprocessing())
    inside = (slice(top, top + region.height), slice(left, left + region.width))
    color = np.ascontiguousarray(rendered.color[inside])
    image = PatchImage.of(replace(observation, color=color))
    return AnnotatedImage(f"render {number}", region, image, rendered.tips - np.array([left, top]), rendered.is_visible)

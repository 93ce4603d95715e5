"""Rendered hands as images to learn finger nails from."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from tracker.detection.annotated_images import AnnotatedImage
from tracker.detection.patch_image import PatchImage
from tracker.model.scene import Scene
from tracker.observation import Region
from tracker.rendering.seen_nails import NailPlaces
from tracker.search.nail_views import MARGIN
from tracker.synthesis.nail_paint import NailPaint
from tracker.synthesis.performance import Moment, Performance, render_moment
from tracker.synthesis.random_hands import RandomHands, arrange_random_hands
from tracker.synthesis.texture import Texture

FEWEST = 400
"""px of hand in an image; one with fewer shows no nail."""

EXPECTED_OFF = 0.006
"""Standard deviation, m, by which the hands of a tracked frame are elsewhere than they are expected."""


NEAR_ENOUGH = RandomHands(nearest=0.30, farthest=0.60, small_camera=0.0)
"""A nail is 9 px wide or more."""


def render_nail_images(count: int, seed: int, how: RandomHands = NEAR_ENOUGH) -> Iterator[AnnotatedImage]:
    """Images of random hands; each depends on the seed and its number only."""
    for number in range(count):
        rng = np.random.default_rng([seed, 1, number])
        performance = arrange_random_hands(how, rng)
        moment = render_moment(performance, 0)
        found = _cut_out(performance, moment, number, rng)
        if found is not None:
            yield found


def _cut_out(performance: Performance, moment: Moment, number: int, rng: np.random.Generator) -> AnnotatedImage | None:
    """The part with hands; None if there is next to nothing of them."""
    camera = performance.camera
    actor = np.where(moment.face >= 0, performance.face_actors[np.maximum(moment.face, 0)], -1)
    is_hand = (actor >= 0) & (actor < len(performance.hands))
    if np.count_nonzero(is_hand) < FEWEST:
        return None
    margin = int(np.ceil(MARGIN * camera.K[0, 0] / np.median(moment.depth[is_hand])))
    rows, columns = np.flatnonzero(is_hand.any(axis=1)), np.flatnonzero(is_hand.any(axis=0))
    top, left = max(0, int(rows[0]) - margin), max(0, int(columns[0]) - margin)
    bottom, right = min(camera.height, int(rows[-1]) + margin + 1), min(camera.width, int(columns[-1]) + margin + 1)
    inside = (slice(top, bottom), slice(left, right))
    color = random_texture(rng).shade(performance, moment, rng)[inside]
    expected = np.where(is_hand, moment.depth, 0.0)[inside].astype(np.float32)
    # What is expected in a tracked frame is not quite where the hands are.
    shift = np.rint(rng.normal(0.0, EXPECTED_OFF, 2) * camera.K[0, 0] / np.median(moment.depth[is_hand])).astype(int)
    image = PatchImage.around(
        np.roll(expected, shift, axis=(0, 1)), np.ascontiguousarray(color), float(camera.K[0, 0]), MARGIN
    )
    places = NailPlaces.of(Scene(tuple(one.model for one in performance.actors)))
    first = np.array([left, top], dtype=np.float64)
    is_visible = places.find_visible(moment.vertices, camera, moment.depth[inside], first)
    pixels = camera.project(places.points(moment.vertices)) - first
    region = Region(top, left, bottom - top, right - left, 0.05, float(moment.depth.max()))
    # What is left out shows no nail for sure, and teaches what is none: fingers' ends that are turned away, above all.
    kept = is_visible | places.find_flat(moment.vertices, camera)
    return AnnotatedImage(f"render {number}", region, image, pixels[kept], is_visible[kept])


def random_texture(rng: np.random.Generator) -> Texture:
    """Skin and nails of a random person, before one of a few walls."""
    light = np.clip(rng.normal([0.78, 0.50, 0.42], 0.08), 0.15, 0.95)
    edge = np.clip(light + rng.uniform(0.0, 0.3), 0.15, 0.95)
    paint = NailPaint(_color(light), _color(edge), float(rng.uniform(0.5, 0.95)))
    return Texture(int(rng.integers(8)), float(rng.uniform(0.001, 0.004)), float(rng.uniform(0.03, 0.16)), nails=paint)


def _color(values: npt.NDArray[np.float64]) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])

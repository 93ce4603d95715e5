"""Hands to export: random ones for properties, hands in space for formats that hold nothing else."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tests.tracker.label_formats.conftest import FRAMES, make_sequence
from tracker.capture.annotations import Annotation, Annotations
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.label_set import LabelSet

PIXELS = st.floats(1.0, 470.0, allow_nan=False, width=64)


@st.composite
def points(draw: st.DrawFn) -> np.ndarray:
    """(21, 3), at least one joint there; joints that are not are unset (0, 0) or outside (-1, -1)."""
    pixels = draw(arrays(np.float64, (21, 2), elements=PIXELS))
    states = draw(st.lists(st.sampled_from("vvoux"), min_size=21, max_size=21))
    states[draw(st.integers(0, 20))] = "v"
    rows = np.c_[pixels, np.zeros(21)]
    for row, state in zip(rows, states, strict=True):
        if state in "vo":
            row[2] = 2 if state == "v" else 1
        else:
            row[:] = (0, 0, 0) if state == "u" else (-1, -1, 0)
    return rows


@st.composite
def label_sets(draw: st.DrawFn, cameras: int = 2) -> LabelSet:
    """Some hands in some images of a recording."""
    sequence = make_sequence(cameras)
    place = st.tuples(st.integers(0, FRAMES - 1), st.integers(0, cameras - 1), st.sampled_from(("right", "left")))
    places = draw(st.lists(place, min_size=1, max_size=5, unique=True))
    items = tuple(Annotation(frame, f"cam{camera}", hand, draw(points())) for frame, camera, hand in places)
    return LabelSet("a" * 8, sequence, list_image_names(sequence), Annotations(items))


def place_hand(side: str, frame: int) -> np.ndarray:
    """(21, 3) world, m: joints near the place that all cameras look at."""
    rng = np.random.default_rng(frame + (100 if side == "left" else 0))
    return np.array([0.0, 0.0, 0.6]) + rng.uniform(-0.07, 0.07, (21, 3))


def flatten(points_: np.ndarray) -> np.ndarray:
    """What a format keeps that knows only whether a joint is there."""
    kept = points_.copy()
    kept[points_[:, 2] > 0, 2] = 2
    kept[points_[:, 2] == 0] = 0
    return kept


def drop_outside(points_: np.ndarray) -> np.ndarray:
    """What a format keeps that has one word for outside and for unset."""
    return np.where(points_[:, 2:] > 0, points_, 0.0)

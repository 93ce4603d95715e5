"""Pictures of depth: near is bright, far is dark, no value is nothing."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.sequences.depth_colors import index_depth, load_palette


@given(st.floats(0.0, 2.0), st.floats(0.01, 5.0), st.lists(st.integers(0, 65535), min_size=1, max_size=20))
def test_nearer_is_never_darker_and_only_no_value_is_nothing(near: float, span: float, raw: list[int]) -> None:
    depth = np.array([sorted(raw)], dtype=np.uint16)
    index = index_depth(depth, 0.001, near, near + span)
    assert ((index == 0) == (depth == 0)).all()
    assert (np.diff(index[0][depth[0] > 0].astype(int)) <= 0).all()


def test_the_ends_of_the_range_are_the_ends_of_the_palette() -> None:
    raw = np.array([[0, 100, 500, 1000, 1500, 60000]], dtype=np.uint16)
    assert index_depth(raw, 0.001, 0.5, 1.5).tolist() == [[0, 255, 255, 128, 1, 1]]


@pytest.mark.parametrize("name", ["turbo", "viridis", "gray"])
def test_a_palette_has_black_for_no_value_and_another_colour_for_each_depth(name) -> None:
    palette = load_palette(name)
    assert palette.shape == (256, 3) and palette.dtype == np.uint8 and palette[0].tolist() == [0, 0, 0]
    assert len(np.unique(palette[1:], axis=0)) > 200


def test_grey_and_viridis_grow_brighter_towards_the_camera() -> None:
    for name in ("gray", "viridis"):
        assert load_palette(name)[255].sum() > load_palette(name)[128].sum() > load_palette(name)[1].sum()

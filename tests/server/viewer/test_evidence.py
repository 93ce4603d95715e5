"""Errors are coloured from none to much, as the page's legend has them."""

from __future__ import annotations

import numpy as np
import pytest

from server.viewer.evidence import ERROR_ANCHORS, UNSEEN_COLOR, error_colors


def test_each_anchor_has_its_colour_and_between_two_lies_their_mean() -> None:
    shares = np.linspace(0.0, 1.0, len(ERROR_ANCHORS))
    assert np.array_equal(error_colors(shares), ERROR_ANCHORS.astype(np.uint8))
    [between] = error_colors(np.array([0.125]))
    assert np.abs(between - ERROR_ANCHORS[:2].mean(axis=0)).max() <= 0.5


@pytest.mark.parametrize(("share", "anchor"), [(-3.0, 0), (7.0, -1), (np.inf, -1), (-np.inf, 0)])
def test_beyond_the_legend_the_colour_is_that_of_its_end(share: float, anchor: int) -> None:
    assert error_colors(np.array([share])).tolist() == [ERROR_ANCHORS[anchor].tolist()]


def test_what_no_camera_saw_is_grey() -> None:
    colors = error_colors(np.array([np.nan, 0.0]))
    assert tuple(colors[0]) == UNSEEN_COLOR and tuple(colors[1]) == tuple(ERROR_ANCHORS[0])
    assert colors.dtype == np.uint8 and error_colors(np.zeros(0)).shape == (0, 3)

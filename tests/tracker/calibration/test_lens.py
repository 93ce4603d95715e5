"""Lenses from one camera's views."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, film
from tracker.calibration.lens import choose_views, fit_lens
from tracker.calibration.sightings import Sightings
from tracker.errors import CalibrationError


def test_a_lens_starts_within_a_hundredth_and_false_views_do_not_spoil_it(rng: np.random.Generator) -> None:
    filmed = film(2, seconds=12.0, fps=10.0)
    seen = filmed.sight(0, rng)
    seen.corners[::12] += rng.normal(size=seen.corners[::12].shape) * 8.0
    lens = fit_lens(seen, BOARD)
    assert lens.K[0, 0] == pytest.approx(filmed.cameras[0].K[0, 0], rel=0.01)
    assert 0 < lens.focal_std < 0.02 * lens.K[0, 0]


def test_views_that_differ_are_chosen(rng: np.random.Generator) -> None:
    seen = film(2, seconds=12.0, fps=10.0).sight(0, rng)
    views = choose_views(seen, 10)
    assert len(views) == len(set(views)) == 10
    centres = np.nanmean(seen.corners, axis=1)
    assert np.ptp(centres[views], axis=0) == pytest.approx(np.ptp(centres, axis=0), rel=0.35)


def test_a_board_that_was_held_alike_in_all_frames_tells_no_lens_and_that_is_said(rng: np.random.Generator) -> None:
    flat = BOARD.corners[:, :2] * 600 + [500, 300]
    corners = np.array([flat + 0.2 * rng.normal(size=flat.shape) for _ in range(10)])
    seen = Sightings("cam7", 1280, 720, 30.0, np.arange(10) / 30, np.arange(10), corners)
    with pytest.raises(CalibrationError, match=r"cam7: its lens cannot be told .* tilted"):
        fit_lens(seen, BOARD)

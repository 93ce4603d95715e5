"""How surely cameras are known is the inverse of all normal equations, and is told in pixels of a picture."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.true_cameras import CORNERS, TIMES, TRUTH
from tracker.calibration.bundle import Freedom, Layout, find_jacobian
from tracker.calibration.camera_certainty import find_covariance, find_pixel_std


def problem(freedom: Freedom) -> tuple[Layout, np.ndarray]:
    layout = Layout(3, len(TIMES), freedom)
    J = find_jacobian(TRUTH, layout, CORNERS, freedom, np.zeros(layout.size))
    return layout, J


def test_the_covariance_of_the_cameras_is_their_part_of_the_inverse_of_all_normal_equations() -> None:
    """[Triggs et al. 2000] section 9, by the whole dense matrix."""
    freedom = Freedom(lenses=False, offsets=False)
    layout, J = problem(freedom)
    dense = J.toarray()
    whole = np.linalg.inv(dense.T @ dense)[layout.places :, layout.places :]
    found = find_covariance(J, layout.places, 0.5)
    assert np.allclose(found, 0.25 * whole, rtol=1e-3, atol=1e-3 * np.abs(0.25 * whole).max())
    assert np.linalg.eigvalsh(found).min() > 0.0


def test_doubts_of_a_picture_grow_with_the_noise_and_the_first_camera_which_stands_still_has_none() -> None:
    freedom = Freedom(lenses=False, offsets=False)
    layout, J = problem(freedom)
    quiet, loud = (find_covariance(J, layout.places, sigma) for sigma in (0.2, 0.4))
    doubts = [find_pixel_std(TRUTH, number, freedom, quiet, 1.0) for number in range(3)]
    assert doubts[0] < 1e-3 < min(doubts[1:]) and max(doubts) < 2.0, "px"
    assert find_pixel_std(TRUTH, 1, freedom, loud, 1.0) == pytest.approx(2.0 * doubts[1])

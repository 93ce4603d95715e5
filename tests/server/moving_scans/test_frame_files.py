"""Frames are drawn upright, whichever way their scanner calls up."""

from __future__ import annotations

import numpy as np
import pytest

from server.moving_scans.frame_files import find_standing

BOARD = np.array([[x, y, z] for x in (-0.25, 0.25) for y in (0.0, 1.7) for z in (-0.1, 0.1)])
TO_Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.4, -2.1])
@pytest.mark.parametrize("is_z_up", [False, True])
def test_a_person_is_seen_upright_from_the_broad_side(angle: float, is_z_up: bool) -> None:
    about_up = np.array([[np.cos(angle), 0.0, np.sin(angle)], [0.0, 1.0, 0.0], [-np.sin(angle), 0.0, np.cos(angle)]])
    points = BOARD @ about_up.T
    points = points @ TO_Z_UP.T if is_z_up else points
    turn = find_standing(points)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    seen = points @ turn.T
    np.testing.assert_allclose(np.ptp(seen, axis=0), [0.5, 1.7, 0.2], atol=1e-9)
    assert seen[np.argmax(BOARD[:, 1])][1] > seen[np.argmin(BOARD[:, 1])][1], "the head is on top"

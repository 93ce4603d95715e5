"""Stiff hands pulled to where they fit: back to the truth from near by, and the cost tells poses apart."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.blend_limits import blend_limits
from tracker.registration.nearest_grid import build_nearest_grid
from tracker.registration.rigid_search import StiffHand, place_stiffly
from tracker.registration.start_poses import make_start_pose

STRAIGHT, FIST = 0, 3
"""Numbers in START_POSES."""


def make_stiff(fit, number: int) -> StiffHand:
    vertices = fit.model.pose_at(make_start_pose(blend_limits(fit.model), number)).vertices.copy()
    grid = build_nearest_grid(vertices, find_unit_normals(vertices, fit.search.faces))
    return StiffHand(grid, fit.search.is_rim_vertex, fit.inner[:200])


def place_near(fit, number: int, size: float = 1.0):
    """A straight hand scanned where it is, and a stiff hand of a pose placed from 0.3 rad and 12 mm away."""
    truth = make_stiff(fit, STRAIGHT)
    points = truth.grid.points * size
    scan = build_nearest_grid(points, truth.grid.normals)
    few = fit.inner[:200]
    R = Rotation.from_rotvec([0.2, -0.15, 0.17]).as_matrix()
    t = np.array([0.012, -0.006, 0.004])
    return place_stiffly(make_stiff(fit, number), scan, points[few], truth.grid.normals[few], R[None], t[None])[0]


def test_a_hand_of_the_right_pose_comes_back_to_its_place(fit):
    placing = place_near(fit, STRAIGHT)
    angle = np.linalg.norm(Rotation.from_matrix(placing.R).as_rotvec())
    assert np.degrees(angle) < 1.5
    assert np.linalg.norm(placing.t) < 0.002
    assert placing.size == pytest.approx(1.0, abs=0.015)


def test_a_larger_hand_is_told_by_its_size(fit):
    assert place_near(fit, STRAIGHT, 1.08).size == pytest.approx(1.08, abs=0.03)


def test_a_hand_of_another_pose_costs_several_times_as_much(fit):
    assert place_near(fit, FIST).cost > 3.0 * place_near(fit, STRAIGHT).cost


def test_placings_are_rotations_and_the_given_ones_stay_as_they_were(fit):
    stiff = make_stiff(fit, STRAIGHT)
    few = fit.inner[:200]
    Rs = Rotation.random(6, rng=np.random.default_rng(1)).as_matrix()
    ts, before = np.zeros((6, 3)), Rs.copy()
    placed = place_stiffly(stiff, stiff.grid, stiff.grid.points[few], stiff.grid.normals[few], Rs, ts)
    assert (before == Rs).all() and (ts == 0.0).all()
    for placing in placed:
        assert pytest.approx(np.eye(3), abs=1e-9) == placing.R @ placing.R.T
        assert 0.8 <= placing.size <= 1.25 and placing.cost >= 0.0

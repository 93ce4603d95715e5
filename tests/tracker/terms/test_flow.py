"""Surface points that go where optical flow took them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import HAND, SCENE, look_from
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.geometry import se3
from tracker.observation.image_flow import ImageFlow
from tracker.rendering import render_view
from tracker.terms.flow import Flow, follow_surface, join_flows
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.surface_point import find_shares

VIEWS = [replace(look_from(angle), distortion=np.zeros(0)) for angle in (0.0, 0.8, 1.6)]


@pytest.fixture(scope="module")
def poses() -> tuple[np.ndarray, np.ndarray]:
    """Of the frame before and of this one."""
    before = SCENE.rest_pose()
    before[6:] = curl_fingers(HAND, 0.2)
    T = se3.exp(np.array([0.0, 0.0, 0.0, 0.6, -0.4, 0.9]))
    T[:3, 3] -= (T @ np.append(SCENE.pose_at(before).landmarks(0).mean(axis=0), 1.0))[:3]
    before[:6] = se3.log(T @ se3.exp(before[:6]))
    now = before.copy()
    now[:3] += [0.003, -0.002, 0.002]
    now[6:] += 0.05 * (now[6:] != 0.0)
    return before, now


@pytest.fixture(scope="module")
def flows(poses) -> list[ImageFlow]:
    """Exact flow of the hand in every view."""
    before, now = (SCENE.pose_at(pose) for pose in poses)
    found = []
    for camera in VIEWS:
        view = render_view(before, camera.K, camera.T_world_camera, camera.height, camera.width)
        rows, columns = np.nonzero(view.face >= 0)
        ids = SCENE.arrays.faces[view.face[rows, columns]]
        shares = find_shares(ids, view.projected, columns, rows)
        ends = np.full((camera.height, camera.width, 2), np.nan, dtype=np.float32)
        ends[rows, columns] = camera.project(np.einsum("nc,nci->ni", shares, now.vertices[ids]))
        found.append(ImageFlow(camera.K, camera.T_world_camera, ends))
    return found


def test_flow_takes_the_hand_to_where_it_is(poses, flows):
    before, now = poses
    term = join_flows([follow_surface(SCENE.pose_at(before), flow) for flow in flows])
    assert len(term.ids) > 100
    objective = Objective(terms={"flow": replace(term, reach=20.0)})
    found = fit_frame(SCENE, None, before, before, objective, FitOptions(iterations=12)).pose
    start, end = (
        1000.0 * np.linalg.norm(SCENE.pose_at(pose).landmarks(0) - SCENE.pose_at(now).landmarks(0), axis=1).mean()
        for pose in (before, found)
    )
    assert start > 3.0
    assert end < 0.5


def test_points_that_did_not_move_have_no_cost_and_those_near_a_contour_are_left_out(poses):
    before = SCENE.pose_at(poses[0])
    camera = VIEWS[0]
    columns, rows = np.meshgrid(np.arange(640, dtype=np.float32), np.arange(480, dtype=np.float32))
    still = ImageFlow(camera.K, camera.T_world_camera, np.dstack([columns, rows]))
    term = follow_surface(before, still, stride=2)
    residual = term.find(before)
    equations = NormalEquations.at(before)
    residual.add_to(equations)
    assert equations.cost < 1e-12
    drawn = np.count_nonzero(render_view(before, camera.K, camera.T_world_camera, 480, 640).face >= 0)
    assert 0.2 * drawn / 4 < len(term.ids) < 0.9 * drawn / 4


def test_a_point_whose_flow_is_far_off_lets_go(poses, flows):
    term: Flow = replace(follow_surface(SCENE.pose_at(poses[0]), flows[0]), weight=1.0, reach=3.0)
    weights = term.find(SCENE.pose_at(poses[1])).weights
    np.testing.assert_allclose(weights, 1.0, atol=1e-3)
    away = poses[1].copy()
    away[:3] += 0.030
    assert term.find(SCENE.pose_at(away)).weights.max() < 0.01


def test_jacobian_agrees_with_finite_differences_and_the_fast_sum_with_it(poses, flows):
    posed = SCENE.pose_at(poses[0])
    residual = follow_surface(posed, flows[1]).find(posed)
    block = residual.linearize(posed)
    step = 1e-6
    for dof in range(SCENE.num_dofs):
        delta = np.zeros(SCENE.num_dofs)
        delta[dof] = step
        ahead = residual.linearize(SCENE.pose_at(SCENE.retract(poses[0], delta))).residual
        behind = residual.linearize(SCENE.pose_at(SCENE.retract(poses[0], -delta))).residual
        np.testing.assert_allclose(block.jacobian[:, dof], (ahead - behind) / (2 * step), atol=2e-3)
    equations = NormalEquations.at(posed)
    residual.add_to(equations)
    JtJ, Jtr = equations.assemble()
    weighted = block.jacobian * block.weights[:, None]
    np.testing.assert_allclose(JtJ, block.jacobian.T @ weighted, rtol=1e-6, atol=1e-4 * np.abs(JtJ).max())
    np.testing.assert_allclose(Jtr, weighted.T @ block.residual, rtol=1e-6, atol=1e-6 * np.abs(Jtr).max())

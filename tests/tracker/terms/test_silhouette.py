"""What is drawn into free space is pushed across the image to where something was seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import DrawnScene, drawn_hand, drawn_tube
from tracker.geometry import se3
from tracker.terms.silhouette import Silhouette

ELSEWHERE = se3.exp(np.array([0.4, -0.2, 0.7, 0.3, -0.8, 0.5]))


@pytest.fixture(scope="module")
def drawn() -> DrawnScene:
    return drawn_tube(ELSEWHERE)


def aside(drawn: DrawnScene, *shift: float):
    """The scene moved along the camera's axes, m."""
    step = np.zeros(drawn.scene.num_dofs)
    step[:3] = drawn.camera.T_world_camera[:3, :3] @ shift
    return drawn.scene.pose_at(drawn.scene.retract(drawn.pose, step))


def look_into(drawn: DrawnScene, posed, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pixels (N, 2) and depths (N,), m, in the region's image."""
    T = se3.inverse(drawn.camera.T_world_camera)
    here = se3.transform(T, points)
    K = drawn.observation.K
    return here[:, :2] / here[:, 2:] * K[[0, 1], [0, 1]] + K[:2, 2], here[:, 2]


def test_each_free_pixel_of_the_grid_is_pulled_to_the_nearest_pixel_with_a_label(drawn):
    posed = aside(drawn, 0.004, 0.010, 0.0)
    context, term = drawn.context(posed), Silhouette()
    residual = term.find(posed, context)
    rows, columns = np.nonzero((context.view.face >= 0) & (drawn.observation.labels == 0))
    on_grid = (rows % 2 == 1) & (columns % 2 == 1)
    free = np.column_stack([columns, rows])[on_grid]
    pixels, depths = look_into(drawn, posed, residual.points(posed))
    towards = drawn.observation.nearest_pixel[1, free[:, 1], free[:, 0], ::-1]
    goes = np.any(towards != free, axis=1)  # holes of a few pixels count as seen
    assert goes.sum() > 50
    np.testing.assert_allclose(pixels, free[goes], atol=1e-6)
    ends, _ = look_into(drawn, posed, residual.targets)
    moves, wanted = ends - pixels, (towards - free)[goes]
    cosines = np.einsum("ni,ni->n", moves, wanted) / np.linalg.norm(moves, axis=1) / np.linalg.norm(wanted, axis=1)
    assert cosines.min() > 0.99
    pull = np.einsum("ni,ni->n", residual.normals, residual.targets - residual.points(posed))
    expected = np.linalg.norm(wanted, axis=1) * depths / drawn.observation.K[0, 0]
    np.testing.assert_allclose(pull, np.minimum(expected, term.max_distance), rtol=1e-9)


def test_the_pull_is_square_to_the_viewing_ray_and_of_unit_direction(drawn):
    posed = aside(drawn, 0.0, -0.012, 0.0)
    residual = Silhouette().find(posed, drawn.context(posed))
    rays = residual.points(posed) - drawn.camera.T_world_camera[:3, 3]
    np.testing.assert_allclose(np.einsum("ni,ni->n", residual.normals, rays), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(residual.normals, axis=1), 1.0)


def test_a_farther_pixel_pulls_no_harder_than_the_limit(drawn):
    posed = aside(drawn, 0.0, 0.015, 0.0)
    context = drawn.context(posed)
    pulls = {}
    for limit in (0.040, 0.005):
        found = Silhouette(max_distance=limit).find(posed, context)
        pulls[limit] = np.linalg.norm(found.targets - found.points(posed), axis=1)
    assert pulls[0.040].max() > 0.010
    np.testing.assert_allclose(pulls[0.005], np.minimum(pulls[0.040], 0.005))


def test_surface_behind_something_nearer_is_left_alone_and_in_front_of_it_is_not(drawn):
    """What is seen in every pixel is of another label; nearer than the model it hides it."""
    posed = aside(drawn, 0.0, 0.010, 0.0)
    context = drawn.context(posed)
    seen, depth = drawn.observation, context.view.depth.astype(np.float32)
    other = np.full_like(seen.labels, 1)
    counts = {}
    for behind in (-0.05, 0.009, 0.011):
        wall = np.where(depth > 0.0, depth + np.float32(behind), np.float32(0.3))
        hidden = replace(context, observation=replace(seen, labels=other, depth=wall))
        counts[behind] = Silhouette().find(posed, hidden).count
    assert counts[-0.05] == counts[0.009] == 0
    assert counts[0.011] > 50


def test_nothing_is_pulled_where_everything_drawn_was_seen_or_nothing_at_all(drawn):
    posed = aside(drawn, 0.0, 0.0, 0.0)
    assert Silhouette().find(posed, drawn.context(posed)).count == 0
    away = aside(drawn, 0.0, 0.010, 0.0)
    context = drawn.context(away)
    nothing = replace(drawn.observation, nearest_pixel=np.full_like(drawn.observation.nearest_pixel, -1))
    assert Silhouette().find(away, replace(context, observation=nothing)).count == 0


def test_a_hand_goes_to_pixels_of_hands_and_a_thing_to_those_of_things():
    hand = drawn_hand()
    posed = hand.scene.pose_at(hand.scene.retract(hand.pose, np.r_[0.012, np.zeros(hand.scene.num_dofs - 1)]))
    context, seen = hand.context(posed), hand.observation
    assert Silhouette().find(posed, context).count > 50
    for kind, is_pulled in ((0, False), (1, True)):
        nearest = seen.nearest_pixel.copy()
        nearest[kind] = -1
        found = Silhouette().find(posed, replace(context, observation=replace(seen, nearest_pixel=nearest)))
        assert (found.count > 50) == is_pulled


def test_the_coarse_form_looks_at_a_quarter_of_the_pixels(drawn):
    posed = aside(drawn, 0.0, 0.012, 0.0)
    fine, coarse = (term.find(posed, drawn.context(posed)) for term in (Silhouette(), Silhouette().coarse()))
    assert coarse.count == pytest.approx(fine.count / 4, rel=0.25)
    assert set(fine.weights) == set(coarse.weights) == {Silhouette().weight}

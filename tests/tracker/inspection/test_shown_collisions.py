"""What the collision term sees is shown once, in metres, the deepest first."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.terms.test_penetration import RADIUS, two_tubes
from tests.tracker.toys import tube
from tracker.geometry.triangles import do_triangles_cross
from tracker.inspection.shown_collisions import show_collisions
from tracker.model.scene import Scene
from tracker.terms.penetration import measure_penetration


def test_what_does_not_touch_shows_nothing() -> None:
    scene, pose = two_tubes((0.0, 0.0, 2 * RADIUS + 1e-4))
    shown = show_collisions(scene.pose_at(pose), ("a", "b"))
    assert shown.triangles.shape == (0, 3, 3) and shown.vertices.shape == (0, 3)
    assert shown.depths.shape == (0,) and shown.pairs == ()


@pytest.mark.parametrize("depth", [0.001, 0.003, 0.006])
def test_two_parts_are_one_pair_as_deep_as_they_penetrate_where_they_do(depth: float) -> None:
    scene, pose = two_tubes((0.001, 0.0, 2 * RADIUS - depth))
    posed = scene.pose_at(pose)
    shown = show_collisions(posed, ("a", "b"))
    (pair,) = shown.pairs
    assert (pair.first, pair.second) == ("a", "b") and pair.crossings > 0
    assert pair.depth == pytest.approx(measure_penetration(posed), abs=1e-6)
    assert pair.depth == shown.depths.max()
    np.testing.assert_array_equal(pair.deepest_at, shown.vertices[shown.depths.argmax()])
    assert abs(pair.deepest_at[2] - RADIUS) < depth + 1e-6, "in the lens that both share"


def test_each_crossing_triangle_is_shown_once_and_crosses_one_of_the_other_part() -> None:
    scene, pose = two_tubes((0.005, 0.002, 0.012), sides=10)
    posed = scene.pose_at(pose)
    shown = show_collisions(posed, ("a", "b"))
    keys = {tuple(triangle.ravel().tolist()) for triangle in shown.triangles}
    assert len(keys) == len(shown.triangles) > 4
    faces, models = scene.arrays.faces, scene.face_models
    first, second = (np.flatnonzero(models == model) for model in (0, 1))
    lowest, highest = posed.vertices[faces].min(axis=1), posed.vertices[faces].max(axis=1)
    pairs = [
        (f, g)
        for f in first
        for g in second[((lowest[second] <= highest[f]) & (lowest[f] <= highest[second])).all(axis=1)]
        if do_triangles_cross(posed.vertices, faces, f, g)
    ]
    corners = posed.vertices[faces[np.unique(pairs)]].astype(np.float32)
    assert keys == {tuple(triangle.ravel().tolist()) for triangle in corners}


def test_vertices_are_inside_the_other_tube_by_their_depth() -> None:
    scene, pose = two_tubes((0.02, 0.0, 0.012))
    shown = show_collisions(scene.pose_at(pose), ("a", "b"))
    x, y, z = shown.vertices.T
    in_first, in_second = RADIUS - np.hypot(y, z), RADIUS - np.hypot(y, z - 0.012)
    assert len(shown.vertices) > 5 and (np.minimum(in_first, in_second) > -1e-4).all(), "each is on one, in the other"
    is_round = (x > 0.022) & (x < 0.028)
    np.testing.assert_allclose(shown.depths[is_round], np.maximum(in_first, in_second)[is_round], atol=2e-4)


def test_a_body_swallowed_whole_is_a_pair_without_crossings() -> None:
    scene, pose = two_tubes((0.012, 0.001, 0.0), radius=0.002, length=0.006)
    (pair,) = show_collisions(scene.pose_at(pose), ("whale", "jonah")).pairs
    assert (pair.first, pair.second, pair.crossings) == ("whale", "jonah", 0)
    assert pair.depth > 0.006


def test_the_deepest_pair_comes_first_whatever_the_order_of_the_models() -> None:
    tubes = tuple(tube(bones=1, rings=11, sides=32) for _ in range(3))
    scene = Scene(tubes)
    for shallow, deep in ((1, 2), (2, 1)):
        pose = scene.rest_pose()
        pose[6 * shallow + 2] = 2 * RADIUS - 0.001
        pose[6 * deep + 2] = -2 * RADIUS + 0.004
        shown = show_collisions(scene.pose_at(pose), ("a", "b", "c"))
        assert [pair.second for pair in shown.pairs] == ["abc"[deep], "abc"[shallow]]
        np.testing.assert_allclose([pair.depth for pair in shown.pairs], [0.004, 0.001], atol=2e-4)

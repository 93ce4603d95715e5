"""How deep parts are in each other."""

import numpy as np
import pytest

from tests.tracker.terms.test_colliding_parts import bent
from tests.tracker.toys import tube
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.terms.colliding_parts import find_crossings
from tracker.terms.penetration import find_swallowed, measure_penetration

RADIUS = 0.008


def two_tubes(
    shift: tuple[float, float, float], radius: float = RADIUS, length: float = 0.03, sides: int = 32
) -> tuple:
    """A fixed tube along x and a second one moved from it by `shift`, m."""
    second = tube(bones=1, rings=11, sides=sides, radius=radius, length=length)
    scene = Scene((tube(bones=1, rings=11, sides=sides), second))
    pose = scene.rest_pose()
    pose[6:9] = shift
    return scene, pose


@pytest.mark.parametrize("depth", [0.0005, 0.001, 0.003, 0.006])
def test_tubes_side_by_side_penetrate_by_what_is_missing_between_them(depth):
    scene, pose = two_tubes((0.001, 0.0, 2 * RADIUS - depth))
    assert measure_penetration(scene.pose_at(pose)) == pytest.approx(depth, abs=2e-4)


def test_what_does_not_touch_does_not_penetrate():
    scene, pose = two_tubes((0.0, 0.0, 2 * RADIUS + 1e-4))
    assert measure_penetration(scene.pose_at(pose)) == 0.0


def test_a_body_that_is_wholly_inside_another_is_found_though_no_triangles_cross():
    scene, pose = two_tubes((0.012, 0.001, 0.0), radius=0.002, length=0.006)
    posed = scene.pose_at(pose)
    crossings = find_crossings(posed)
    assert len(crossings.pairs) == 0
    inside = find_swallowed(posed, crossings)
    assert set(inside.ids) == set(range(*scene.vertex_slices[1].indices(10**6)))
    deepest = RADIUS - 0.0005  # its axis is 1 mm off, its radius 2 mm: one line of vertices is 1 mm from the axis
    assert measure_penetration(posed) == pytest.approx(deepest, abs=6e-4)


def test_swallowed_vertices_are_those_inside_whose_triangles_cross_nothing():
    scene, pose = two_tubes((0.02, 0.0, 0.005))
    posed = scene.pose_at(pose)
    crossings = find_crossings(posed)
    inside = find_swallowed(posed, crossings)
    every = find_swallowed(posed, crossings, on_crossing_triangles=True)
    crossing = np.unique(scene.arrays.faces[crossings.pairs])
    assert not np.isin(inside.ids, crossing).any()
    assert set(inside.ids) == set(every.ids) - set(crossing)
    first, second = scene.vertex_slices
    for vertices, axis_start in ((second, np.zeros(3)), (first, pose[6:9])):
        points = posed.vertices[vertices] - axis_start
        along, across = points[:, 0], np.linalg.norm(points[:, 1:], axis=1)
        well_inside = (along > 0.0) & (along < 0.03) & (across < 0.98 * RADIUS)
        outside = (along < -RADIUS) | (along > 0.03 + RADIUS) | (across > RADIUS)
        ids = np.arange(vertices.start, vertices.stop)
        assert set(ids[well_inside]) <= set(every.ids)
        assert not set(ids[outside]) & set(every.ids)


def test_the_way_back_ends_on_the_receiver():
    scene, pose = two_tubes((0.02, 0.0, 0.005))
    posed = scene.pose_at(pose)
    inside = find_swallowed(posed, find_crossings(posed), on_crossing_triangles=True)
    assert len(inside.ids) > 20
    ends = posed.vertices[inside.ids] - inside.distances[:, :1] * posed.normals[inside.ids]
    corners = posed.vertices[scene.arrays.faces[inside.receivers]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(np.einsum("ni,ni->n", normals, ends - corners[:, 0]), 0.0, atol=1e-9)
    np.testing.assert_allclose(-np.einsum("ni,ni->n", normals, posed.normals[inside.ids]), inside.cosines, atol=1e-9)


def test_an_open_hand_does_not_penetrate_itself_and_a_fist_does_by_millimetres():
    scene = Scene((default_hand("right"),))
    assert measure_penetration(scene.pose_at(scene.rest_pose())) == 0.0
    fingers = ("index", "middle", "ring", "little")
    turns = [(f"{finger}_{part}", 0, 1.2) for finger in fingers for part in ("proximal", "middle", "distal")]
    fist = measure_penetration(scene.pose_at(bent(scene, *turns)))
    assert 0.001 < fist < 0.012  # fingers of the default hand are 13 to 20 mm thick
    loose = measure_penetration(scene.pose_at(bent(scene, *[(bone, which, 0.5 * a) for bone, which, a in turns])))
    assert loose < fist


def test_penetration_does_not_depend_on_where_the_scene_is():
    scene, pose = two_tubes((0.02, 0.0, 0.005))
    before = measure_penetration(scene.pose_at(pose))
    step = np.r_[0.4, -0.3, 0.6, 0, 0, 0, 0.4, -0.3, 0.6, 0, 0, 0]
    assert measure_penetration(scene.pose_at(scene.retract(pose, step))) == pytest.approx(before, abs=1e-9)


def count_windings_exactly(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(N,) solid angle that triangles (F, 3, 3) span at points (N, 3), in full spheres."""
    a, b, c = (corners[None, :, i] - points[:, None] for i in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    volume = np.einsum("nfi,nfi->nf", a, np.cross(b, c))
    dots = [np.einsum("nfi,nfi->nf", x, y) for x, y in ((a, b), (b, c), (c, a))]
    return 2 * np.arctan2(volume, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb).sum(axis=1) / (4 * np.pi)


def test_in_any_pose_of_two_hands_what_is_called_inside_is_enclosed_by_skin(rng):
    scene = Scene((default_hand("right"), default_hand("left")))
    lower, upper, found = np.maximum(scene.lower, -0.5), np.minimum(scene.upper, 1.6), 0
    for _ in range(10):
        pose = rng.uniform(lower, upper)
        pose[:6], pose[37:43] = 0.0, np.r_[rng.uniform(-0.02, 0.02, size=3), rng.normal(size=3)]
        posed = scene.pose_at(pose)
        inside = find_swallowed(posed, find_crossings(posed), on_crossing_triangles=True)
        receivers = scene.face_models[inside.receivers]
        for model in range(2):
            ids = inside.ids[receivers == model]
            corners = posed.vertices[scene.arrays.faces[scene.face_models == model]]
            just_outside = posed.vertices[ids] + 1e-6 * posed.normals[ids]
            windings = count_windings_exactly(just_outside, corners)
            assert np.all(np.rint(windings) >= 1)
            found += len(ids)
    assert found > 300

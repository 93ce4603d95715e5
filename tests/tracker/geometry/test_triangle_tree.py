"""The tree finds what asking every triangle finds."""

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.geometry.triangle_tree import (
    Filter,
    build_triangle_tree,
    find_crossings_into,
    find_distance,
    find_exits,
    fit_boxes,
)
from tracker.geometry.triangles import compute_squared_distance, do_triangles_cross


def soup(rng, count=150, groups=4, size=0.02):
    """Random small triangles in a cube of 0.1 m, in groups."""
    centers = rng.uniform(0, 0.1, size=(count, 1, 3))
    vertices = (centers + rng.normal(scale=size, size=(count, 3, 3))).reshape(-1, 3)
    faces = np.arange(3 * count, dtype=np.int32).reshape(-1, 3)
    tree = build_triangle_tree(vertices[faces].mean(axis=1), rng.integers(groups, size=count).astype(np.int32), groups)
    return vertices, faces, tree


def all_allowed(tree):
    groups = ~np.eye(len(tree.roots), dtype=bool)
    return Filter(groups, groups[tree.groups])


def crossings(vertices, faces, tree, allowed, room=5000):
    pairs = np.zeros((room, 2), dtype=np.int32)
    count = find_crossings_into(pairs, tree, fit_boxes(tree, vertices, faces), allowed, vertices, faces)
    return count, {frozenset(pair) for pair in pairs[:count].tolist()}


def test_every_triangle_stands_in_one_leaf_of_its_group(rng):
    _, _, tree = soup(rng)
    assert sorted(tree.order) == list(range(150))
    for group, root in enumerate(tree.roots):
        assert set(tree.groups[tree.order[tree.starts[root] : tree.ends[root]]]) == {group}
        assert tree.ends[root] - tree.starts[root] == np.sum(tree.groups == group)


def test_boxes_hold_their_triangles_after_these_have_moved(rng):
    vertices, faces, tree = soup(rng)
    vertices = vertices + rng.normal(scale=0.05, size=vertices.shape)
    boxes = fit_boxes(tree, vertices, faces)
    for node in range(len(tree.starts)):
        inside = vertices[faces[tree.order[tree.starts[node] : tree.ends[node]]]].reshape(-1, 3)
        np.testing.assert_array_equal(boxes.nodes[node], np.r_[inside.min(axis=0), inside.max(axis=0)])


@pytest.mark.parametrize("moved", [0.0, 0.03])
def test_crossings_are_those_of_all_pairs_once_each(rng, moved):
    vertices, faces, tree = soup(rng)
    vertices = vertices + rng.normal(scale=moved, size=vertices.shape)
    count, found = crossings(vertices, faces, tree, all_allowed(tree))
    expected = {
        frozenset((f, g))
        for f in range(len(faces))
        for g in range(f)
        if tree.groups[f] != tree.groups[g] and do_triangles_cross(vertices, faces, f, g)
    }
    assert found == expected
    assert count == len(expected) > 50


def test_filtered_groups_and_triangles_do_not_cross(rng):
    vertices, faces, tree = soup(rng)
    allowed = all_allowed(tree)
    _, before = crossings(vertices, faces, tree, allowed)
    allowed.groups[0, 1] = allowed.groups[1, 0] = False
    f, g = next(tuple(pair) for pair in before if {tree.groups[t] for t in pair} == {2, 3})
    allowed.triangles[f, tree.groups[g]] = False
    _, after = crossings(vertices, faces, tree, allowed)
    gone = {p for p in before if {tree.groups[t] for t in p} == {0, 1}}
    gone |= {p for p in before if f in p and {tree.groups[t] for t in p} == {2, 3}}
    assert after == before - gone


def test_triangles_with_a_common_vertex_do_not_cross():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, -1]], dtype=float)
    faces = np.array([[0, 1, 2], [0, 3, 4]], dtype=np.int32)
    tree = build_triangle_tree(vertices[faces].mean(axis=1), np.array([0, 1], dtype=np.int32), 2)
    assert crossings(vertices, faces, tree, all_allowed(tree))[0] == 0


def test_too_little_room_is_told_and_nothing_is_written_beyond(rng):
    vertices, faces, tree = soup(rng)
    full, _ = crossings(vertices, faces, tree, all_allowed(tree))
    few, found = crossings(vertices, faces, tree, all_allowed(tree), room=7)
    assert few == full
    assert len(found) == 7


def closed_tube(radius=0.01):
    model = tube(bones=1, rings=9, sides=24, radius=radius)
    faces = model.faces.astype(np.int32)
    groups = np.zeros(len(faces), dtype=np.int32)
    tree = build_triangle_tree(model.vertices[faces].mean(axis=1), groups, 2)
    allowed = Filter(np.ones((2, 2), dtype=bool), np.ones((len(faces), 2), dtype=bool))
    return model.vertices, faces, tree, allowed


def test_the_way_out_of_a_tube_is_the_rest_of_its_radius(rng):
    vertices, faces, tree, allowed = closed_tube()
    boxes, may_meet = fit_boxes(tree, vertices, faces), np.array([True, True])
    for _ in range(200):
        angle, radius = rng.uniform(0, 2 * np.pi), rng.uniform(0, 0.02)
        outwards = np.array([0.0, np.cos(angle), np.sin(angle)])
        point = np.array([rng.uniform(0.002, 0.028), 0, 0]) + radius * outwards
        _, back, cosine, ahead = find_exits(tree, boxes, allowed, may_meet, 1, 0, 1, vertices, faces, point, outwards)
        triangle = find_exits(tree, boxes, allowed, may_meet, 1, 0, 1, vertices, faces, point, outwards)[0]
        if radius < 0.0098:
            assert triangle >= 0
            assert back == pytest.approx(0.01 + radius, abs=1e-4)
            assert ahead == pytest.approx(0.01 - radius, abs=1e-4)
            assert 0.97 < cosine <= 1.0
        elif radius > 0.01:
            assert triangle == -1


def test_a_group_that_may_not_be_met_is_passed_through():
    vertices, faces, tree, allowed = closed_tube()
    boxes = fit_boxes(tree, vertices, faces)
    point, up = np.array([0.015, 0.0, 0.001]), np.array([0.0, 0.0, 1.0])
    assert find_exits(tree, boxes, allowed, np.array([True, True]), 1, 0, 1, vertices, faces, point, up)[0] >= 0
    assert find_exits(tree, boxes, allowed, np.array([False, True]), 1, 0, 1, vertices, faces, point, up)[0] == -1
    allowed.triangles[:, 1] = False
    assert find_exits(tree, boxes, allowed, np.array([True, True]), 1, 0, 1, vertices, faces, point, up)[0] == -1


def test_distance_is_that_to_the_nearest_of_all_triangles(rng):
    vertices, faces, tree = soup(rng)
    boxes, allowed, may_meet = fit_boxes(tree, vertices, faces), all_allowed(tree), np.array([False, True, True, True])
    for _ in range(50):
        point = rng.uniform(-0.05, 0.15, size=3)
        found = find_distance(tree, boxes, allowed, may_meet, 0, 0, 4, vertices, faces, point)
        others = np.flatnonzero(tree.groups != 0)
        expected = min(compute_squared_distance(vertices, faces, f, *point) for f in others)
        assert found == pytest.approx(np.sqrt(expected))

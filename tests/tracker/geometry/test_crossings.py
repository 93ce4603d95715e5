"""The tree finds the crossings that asking every pair of triangles finds."""

import numpy as np
import pytest

from tests.tracker.geometry.test_triangle_tree import all_allowed, soup
from tracker.geometry.crossings import find_crossings_into
from tracker.geometry.triangle_tree import build_triangle_tree, fit_tree
from tracker.geometry.triangles import do_triangles_cross


def crossings(vertices, faces, tree, allowed, room=5000):
    pairs = np.zeros((room, 2), dtype=np.int32)
    count = find_crossings_into(pairs, fit_tree(tree, allowed, vertices, faces))
    return count, {frozenset(pair) for pair in pairs[:count].tolist()}


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

"""The way out of a body, whether a point is in it, and how deep."""

import numpy as np
import pytest

from tests.tracker.geometry.test_triangle_tree import all_allowed, soup
from tests.tracker.toys import tube
from tracker.geometry.exits import count_windings, find_distance, find_exits
from tracker.geometry.triangle_tree import Filter, FittedTree, build_triangle_tree, fit_tree
from tracker.geometry.triangles import find_closest


def closed_tube(radius=0.01):
    model = tube(bones=1, rings=9, sides=24, radius=radius)
    faces = model.faces.astype(np.int32)
    groups = np.zeros(len(faces), dtype=np.int32)
    tree = build_triangle_tree(model.vertices[faces].mean(axis=1), groups, 2)
    allowed = Filter(np.ones((2, 2), dtype=bool), np.ones((len(faces), 2), dtype=bool))
    return fit_tree(tree, allowed, model.vertices, faces)


@pytest.fixture
def inside_tube() -> FittedTree:
    return closed_tube()


def test_the_way_out_of_a_tube_is_the_rest_of_its_radius(inside_tube, rng):
    may_meet = np.array([True, True])
    for _ in range(200):
        angle, radius = rng.uniform(0, 2 * np.pi), rng.uniform(0, 0.02)
        outwards = np.array([0.0, np.cos(angle), np.sin(angle)])
        point = np.array([rng.uniform(0.002, 0.028), 0, 0]) + radius * outwards
        triangle, back, cosine, ahead = find_exits(inside_tube, may_meet, 1, 0, 1, point, outwards)
        windings = count_windings(inside_tube, 0, 1, point, outwards, -1)
        if radius < 0.0098:
            assert triangle >= 0
            assert windings == 1
            assert back == pytest.approx(0.01 + radius, abs=1e-4)
            assert ahead == pytest.approx(0.01 - radius, abs=1e-4)
            assert 0.97 < cosine <= 1.0
        elif radius > 0.01:
            assert triangle == -1
            assert windings == 0


def test_a_group_that_may_not_be_met_is_passed_through(inside_tube):
    point, up = np.array([0.015, 0.0, 0.001]), np.array([0.0, 0.0, 1.0])
    both, one = np.array([True, True]), np.array([False, True])
    assert find_exits(inside_tube, both, 1, 0, 1, point, up)[0] >= 0
    assert find_exits(inside_tube, one, 1, 0, 1, point, up)[0] == -1
    inside_tube.allowed.triangles[:, 1] = False
    assert find_exits(inside_tube, both, 1, 0, 1, point, up)[0] == -1
    assert count_windings(inside_tube, 0, 1, point, up, -1) == 1


def test_a_vertex_of_a_closed_surface_is_outside_it_and_one_of_a_surface_put_into_itself_is_enclosed(inside_tube):
    vertices, faces = inside_tube.vertices, inside_tube.faces
    for v in range(0, len(vertices), 5):
        outwards = (
            np.r_[0.0, vertices[v, 1:]] if np.any(vertices[v, 1:]) else np.r_[np.sign(vertices[v, 0] - 0.01), 0, 0]
        )
        assert count_windings(inside_tube, 0, 1, vertices[v], outwards / np.linalg.norm(outwards), v) == 0
    small = vertices * 0.5 + np.array([0.007, 0.0, 0.0])
    doubled = np.concatenate([vertices, small])
    both = np.concatenate([faces, faces + len(vertices)]).astype(np.int32)
    groups = np.zeros(len(both), dtype=np.int32)
    tree = build_triangle_tree(doubled[both].mean(axis=1), groups, 2)
    allowed = Filter(np.ones((2, 2), dtype=bool), np.ones((len(both), 2), dtype=bool))
    nested = fit_tree(tree, allowed, doubled, both)
    for v in range(len(vertices), len(vertices) + 24):
        outwards = np.r_[0.0, doubled[v, 1:]] / np.linalg.norm(doubled[v, 1:])
        assert count_windings(nested, 0, 1, doubled[v], outwards, v) == 1


def test_distance_is_that_to_the_nearest_of_all_triangles(rng):
    vertices, faces, tree = soup(rng)
    fitted, may_meet = fit_tree(tree, all_allowed(tree), vertices, faces), np.array([False, True, True, True])
    for _ in range(50):
        point = rng.uniform(-0.05, 0.15, size=3)
        others = np.flatnonzero(tree.groups != 0)
        expected = min(find_closest(*point, vertices, *faces[f])[0] for f in others)
        assert find_distance(fitted, may_meet, 0, 0, 4, point) == pytest.approx(np.sqrt(expected))

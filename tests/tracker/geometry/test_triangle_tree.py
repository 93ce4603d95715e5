"""The tree holds every triangle once, in boxes that follow it."""

import numpy as np

from tracker.geometry.triangle_tree import Filter, build_triangle_tree, fit_tree


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


def test_every_triangle_stands_in_one_leaf_of_its_group(rng):
    _, _, tree = soup(rng)
    assert sorted(tree.order) == list(range(150))
    for group, root in enumerate(tree.roots):
        assert set(tree.groups[tree.order[tree.starts[root] : tree.ends[root]]]) == {group}
        assert tree.ends[root] - tree.starts[root] == np.sum(tree.groups == group)


def test_boxes_hold_their_triangles_after_these_have_moved(rng):
    vertices, faces, tree = soup(rng)
    vertices = vertices + rng.normal(scale=0.05, size=vertices.shape)
    fitted = fit_tree(tree, all_allowed(tree), vertices, faces)
    for node in range(len(tree.starts)):
        inside = vertices[faces[tree.order[tree.starts[node] : tree.ends[node]]]].reshape(-1, 3)
        np.testing.assert_array_equal(fitted.node_boxes[node], np.r_[inside.min(axis=0), inside.max(axis=0)])

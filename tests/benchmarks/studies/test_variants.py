"""Terms of the studies: same correspondences as points, and the simple repulsion that T16 found worse."""

from __future__ import annotations

import numpy as np

from benchmarks.studies.variants import AsPoints, CorrespondingVertices
from tests.tracker.scenes import drawn_tube
from tests.tracker.toys import tube
from tracker.model.scene import Scene
from tracker.terms.colliding_parts import find_crossings
from tracker.terms.model_to_data import ModelToData
from tracker.terms.point_point import PointToPoint


def test_points_in_place_of_planes_keep_the_correspondences():
    drawn = drawn_tube()
    posed = drawn.scene.pose_at(drawn.disturbed(np.random.default_rng(0)))
    context = drawn.context(posed)
    planes = ModelToData().find(posed, context)
    points = AsPoints(ModelToData()).find(posed, context)
    assert isinstance(points, PointToPoint) and points.count == planes.count > 50
    assert np.array_equal(points.ids, planes.ids) and np.array_equal(points.targets, planes.targets)


def crossing_tubes(apart: float):
    """Two tubes across each other, their axes so far apart, m."""
    scene = Scene((tube(bones=1, rings=9, sides=12, radius=0.01), tube(bones=1, rings=9, sides=12, radius=0.01)))
    pose = scene.rest_pose()
    pose[scene.pose_slices[1].start + 3 : scene.pose_slices[1].start + 6] = [0.0, 0.0, np.pi / 2]
    posed = scene.pose_at(pose)
    first, second = (posed.vertices[where].mean(axis=0) for where in scene.vertex_slices)
    pose[scene.pose_slices[1].start : scene.pose_slices[1].start + 3] += first - second + [0.0, 0.0, apart]
    return scene.pose_at(pose)


def test_vertices_of_crossing_triangles_go_to_vertices_of_those_they_cross():
    posed = crossing_tubes(0.017)
    pairs = find_crossings(posed).pairs
    found = CorrespondingVertices(weight=2.0).find(posed)
    faces = posed.scene.arrays.faces
    assert len(pairs) > 0 and found.count == len(np.unique(faces[pairs]))
    assert np.all(found.weights == 2.0)
    crossed = {tuple(posed.vertices[v]) for v in np.unique(faces[pairs])}
    assert all(tuple(target) in crossed for target in found.targets)


def test_nothing_moves_where_nothing_crosses():
    assert CorrespondingVertices().find(crossing_tubes(0.05)).count == 0

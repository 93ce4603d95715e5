"""The nearest pair is what trying all of them gives."""

import numpy as np
import pytest

from tests.tracker.grips import BALL_RADIUS, PINCH, ball, cube, gripped
from tracker.model.decimation import closest_on_triangles
from tracker.physics.closest_points import find_closest_point


@pytest.mark.parametrize("gap", [0.006, 0.001, -0.003])
@pytest.mark.parametrize("thing", [ball(), cube(0.034)], ids=["ball", "cube"])
def test_it_agrees_with_trying_every_pair(gap, thing, rng):
    start = gripped(([1, 0.2, 0.1], [-1, 0, 0]), (gap, gap), thing)
    pose = start.pose.copy()
    pose[3:6] += rng.normal(scale=0.02, size=3)
    posed = start.scene.pose_at(pose)
    scene = posed.scene
    triangles = posed.vertices[scene.models[1].faces + scene.vertex_slices[1].start]
    found = find_closest_point(posed, 0, "thumb_distal", 1)
    hand = scene.models[0].hand
    assert hand is not None
    distances, ids = [], hand.finger_parts["thumb_distal"]
    for vertex in ids:
        shares = closest_on_triangles(posed.vertices[vertex], triangles)
        points = np.einsum("fk,fkx->fx", shares, triangles)
        offsets = np.linalg.norm(points - posed.vertices[vertex], axis=1)
        face = int(np.argmin(offsets))
        normal = np.cross(triangles[face, 1] - triangles[face, 0], triangles[face, 2] - triangles[face, 0])
        is_inside = (posed.vertices[vertex] - points[face]) @ normal < 0.0
        distances.append(-offsets[face] if is_inside else offsets[face])
    skin = scene.models[0].faces[np.isin(scene.models[0].faces, ids).all(axis=1)]
    pads = posed.vertices[skin]
    for vertex in posed.vertices[scene.vertex_slices[1]][: len(scene.models[1].vertices)]:
        points = np.einsum("fk,fkx->fx", closest_on_triangles(vertex, pads), pads)
        if min(distances) > 0.0:
            distances.append(np.linalg.norm(points - vertex, axis=1).min())
    assert found.distance == pytest.approx(min(distances), abs=1e-9)
    assert found.vertex in ids
    np.testing.assert_allclose(found.part_shares @ posed.vertices[found.part_corners], found.part_point, atol=1e-12)
    assert np.linalg.norm(found.part_point - found.point) == pytest.approx(abs(found.distance), abs=1e-9)
    np.testing.assert_allclose(found.shares @ posed.vertices[found.corners], found.point, atol=1e-12)


def test_the_normal_points_out_of_the_object():
    posed = gripped(PINCH, (0.005, 0.005))
    found = find_closest_point(posed, 0, "thumb_distal", 1)
    assert found.normal[0] > 0.8
    assert np.linalg.norm(found.point - [0.05, -0.02, 0.5]) == pytest.approx(BALL_RADIUS, abs=3e-4)


def test_a_flat_pad_touches_a_ball_between_its_corners():
    posed = gripped(PINCH, (0.0005, 0.0005))
    found = find_closest_point(posed, 0, "thumb_distal", 1)
    nearest_corner = np.linalg.norm(posed.vertices[found.part_corners] - posed.landmarks(1)[0], axis=1).min()
    assert found.distance == pytest.approx(0.0005, abs=2e-4)
    assert nearest_corner - BALL_RADIUS > 0.001

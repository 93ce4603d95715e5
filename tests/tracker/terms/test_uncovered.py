"""Data that the drawn model leaves uncovered pulls the nearest of it, and never the palm."""

import numpy as np

from tests.tracker.scenes import drawn_hand, drawn_tube
from tracker.terms.uncovered import Uncovered


def test_an_end_that_curled_up_is_pulled_straight_to_data_far_away():
    drawn = drawn_tube()
    curled = drawn.pose.copy()
    curled[-2] -= 1.2
    posed = drawn.scene.pose_at(curled)
    term = Uncovered()
    residual = term.find(posed, drawn.context(posed))
    far = residual.barycentric[:, 0] == 1.0
    assert far.sum() > 3
    apart = residual.targets[far] - posed.vertices[residual.ids[far, 0]]
    distances = np.linalg.norm(apart, axis=1)
    nearest = np.linalg.norm(residual.targets[far][:, None] - posed.vertices[None, : len(drawn.scene.is_palm)], axis=2)
    surface = drawn.scene.landmark_slices[0].start
    np.testing.assert_allclose(distances, nearest[:, :surface].min(axis=1), atol=1e-9)
    assert distances.max() <= term.max_distance
    np.testing.assert_allclose(residual.normals[far], apart / distances[:, None], atol=1e-6)


def test_each_match_near_by_is_the_nearest_drawn_pixel(rng):
    drawn = drawn_tube()
    posed = drawn.scene.pose_at(drawn.disturbed(rng))
    context, term = drawn.context(posed), Uncovered()
    residual = term.find(posed, context)
    K, view, seen = drawn.observation.K, context.view, drawn.observation
    points = np.einsum("nc,nci->ni", residual.barycentric, posed.vertices[residual.ids])
    near = residual.ids[:, 0] != residual.ids[:, 1]
    assert near.sum() > 20
    drawn_at = np.argwhere(view.face >= 0)[:, ::-1]
    depths = 1.0 / view.inverse_depth[drawn_at[:, 1], drawn_at[:, 0]]
    for point, target in zip(points[near], residual.targets[near], strict=True):
        pixel = (K @ point)[:2] / point[2]
        data = (K @ target)[:2] / target[2]
        column, row = np.rint(data).astype(int)
        alike = np.abs(depths - seen.depth[row, column]) < term.within
        nearest = np.linalg.norm(drawn_at[alike] - data, axis=1).min()
        assert np.linalg.norm(data - pixel) <= nearest + 0.1
        assert np.linalg.norm(data - pixel) <= term.max_pixels + 0.1


def test_what_lies_beyond_the_palm_pulls_nothing():
    drawn = drawn_hand()
    moved = drawn.pose.copy()
    joints = drawn.scene.pose_at(drawn.pose).landmarks(0)
    towards = joints[9] - joints[0]
    moved[:3] += 0.012 * towards / np.linalg.norm(towards)
    posed = drawn.scene.pose_at(moved)
    residual = Uncovered().find(posed, drawn.context(posed))
    assert residual.count > 0
    for corner in range(3):
        assert not drawn.scene.is_palm[residual.ids[:, corner][residual.barycentric[:, corner] > 0]].any()
    bones = drawn.scene.arrays.weight_bones[:, 0]
    assert drawn.scene.is_palm.any() and not drawn.scene.is_palm[bones == 5].any()

"""Each visible vertex meets the nearest point of the cloud that looks its way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import DrawnScene, drawn_tube
from tracker.geometry import se3
from tracker.terms.model_to_data import ModelToData
from tracker.terms.point_plane import PointToPlane
from tracker.terms.point_point import PointToPoint


@pytest.fixture(scope="module")
def drawn() -> DrawnScene:
    return drawn_tube()


@pytest.fixture
def posed(drawn):
    return drawn.scene.pose_at(drawn.disturbed(np.random.default_rng(0)))


def find_visible(drawn: DrawnScene, posed, within: float) -> np.ndarray:
    """(V,) vertices that project into the region and lie at most so far behind what is drawn, m."""
    view = drawn.context(posed).view
    K = drawn.observation.K
    here = se3.transform(se3.inverse(drawn.camera.T_world_camera), posed.vertices)
    pixels = np.rint(here[:, :2] / here[:, 2:] * K[[0, 1], [0, 1]] + K[:2, 2]).astype(int)
    height, width = view.face.shape
    inside = (pixels >= 0).all(axis=1) & (pixels[:, 0] < width) & (pixels[:, 1] < height)
    column, row = np.where(inside[:, None], pixels, 0).T
    in_front = (view.face[row, column] < 0) | (here[:, 2] <= view.depth[row, column] + within)
    return inside & in_front & posed.normals.any(axis=1)


def test_every_visible_vertex_with_an_allowed_point_within_reach_has_its_match_and_no_other(drawn, posed):
    term, seen = ModelToData(), drawn.observation
    residual = term.find(posed, drawn.context(posed))
    cloud, normals = (image[seen.labels > 0].astype(float) for image in (seen.points, seen.normals))
    apart = np.linalg.norm(posed.vertices[:, None] - cloud, axis=2)
    apart[posed.normals @ normals.T < np.cos(np.deg2rad(term.max_angle))] = np.inf
    nearest = apart.min(axis=1)
    visible = find_visible(drawn, posed, term.visible_within)
    found = np.isin(np.arange(len(posed.vertices)), residual.ids[:, 0])
    assert residual.count == found.sum() > 50
    assert np.all(np.diff(residual.ids[:, 0]) > 0), "in the order of the vertices"
    assert not found[~visible].any() and found[visible & (nearest < term.max_distance - 2e-4)].all()
    assert nearest[found].max() < term.max_distance
    distances = np.linalg.norm(residual.targets - posed.vertices[residual.ids[:, 0]], axis=1)
    np.testing.assert_allclose(distances, nearest[found], atol=2e-4)  # the rings of pixels bound it across only


def test_planes_take_the_vertex_normals_and_points_take_none(drawn, posed):
    context = drawn.context(posed)
    planes, points = (ModelToData(to_plane=to_plane, weight=0.7).find(posed, context) for to_plane in (True, False))
    assert isinstance(planes, PointToPlane) and isinstance(points, PointToPoint)
    np.testing.assert_array_equal(planes.normals, posed.normals[planes.ids[:, 0]])
    np.testing.assert_array_equal(points.ids, planes.ids)
    np.testing.assert_array_equal(points.targets, planes.targets)
    assert set(planes.weights) == set(points.weights) == {0.7}
    assert points.linearize(posed).cost >= planes.linearize(posed).cost


def test_the_far_side_is_seen_only_by_who_looks_through_the_surface(drawn, posed):
    context = drawn.context(posed)
    through = ModelToData(visible_within=1.0, max_angle=180.0, max_distance=0.030).find(posed, context)
    surface = ModelToData(max_angle=180.0, max_distance=0.030).find(posed, context)
    away = np.einsum("ni,ni->n", posed.normals[through.ids[:, 0]], posed.vertices[through.ids[:, 0]]) > 0.0
    assert set(surface.ids[:, 0]) < set(through.ids[:, 0])
    assert away.mean() > 0.4, "of a tube about half looks away"


def test_points_of_another_label_are_not_met(drawn, posed):
    context, seen = drawn.context(posed), drawn.observation
    assert ModelToData().find(posed, replace(context, vertex_labels=np.full_like(context.vertex_labels, 4))).count == 0
    half = seen.labels.copy()
    half[:, half.shape[1] // 2 :] = 0
    residual = ModelToData().find(posed, replace(context, observation=replace(seen, labels=half)))
    known = {tuple(point) for point in seen.points[half > 0].astype(float)}
    assert residual.count > 20 and {tuple(target) for target in residual.targets} <= known


def test_a_stride_takes_the_same_matches_of_fewer_vertices(drawn, posed):
    context = drawn.context(posed)
    whole, third = (ModelToData(stride=stride).find(posed, context) for stride in (1, 3))
    kept = whole.ids[:, 0] % 3 == 0
    np.testing.assert_array_equal(third.ids, whole.ids[kept])
    np.testing.assert_array_equal(third.targets, whole.targets[kept])
    assert ModelToData(stride=3).coarse() == ModelToData(stride=12)


def test_landmarks_which_have_no_surface_are_never_matched(drawn, posed):
    landmarks = drawn.scene.landmark_slices[0]
    residual = ModelToData(visible_within=1.0, max_angle=180.0, max_distance=0.1).find(posed, drawn.context(posed))
    assert residual.count > 100 and residual.ids.max() < landmarks.start

"""Every data point meets the nearest drawn surface that looks its way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import DrawnScene, drawn_tube
from tracker.geometry import se3
from tracker.terms.data_to_surface import DataToSurface

ELSEWHERE = se3.exp(np.array([0.4, -0.2, 0.7, 0.3, -0.8, 0.5]))


@pytest.fixture(scope="module")
def drawn() -> DrawnScene:
    return drawn_tube(ELSEWHERE)


@pytest.fixture
def posed(drawn):
    return drawn.scene.pose_at(drawn.disturbed(np.random.default_rng(0)))


def find_plainly(drawn: DrawnScene, context, term: DataToSurface):
    """(row, column) of each data pixel of the grid, and its distance to the nearest drawn point allowed, m."""
    seen, view = drawn.observation, context.view
    rows, columns = np.nonzero(view.face >= 0)
    K, z = seen.K, 1.0 / view.inverse_depth[rows, columns]
    points = np.column_stack([(columns - K[0, 2]) / K[0, 0] * z, (rows - K[1, 2]) / K[1, 1] * z, z])
    surface = se3.transform(seen.T_world_camera, points)
    normals, labels = view.face_normals[view.face[rows, columns]], context.face_labels[view.face[rows, columns]]
    for row in range(term.stride // 2, seen.labels.shape[0], term.stride):
        for column in range(term.stride // 2, seen.labels.shape[1], term.stride):
            if seen.labels[row, column] and seen.normals[row, column].any():
                allowed = (normals @ seen.normals[row, column] >= np.cos(np.deg2rad(term.max_angle))) & (
                    labels & seen.labels[row, column] > 0
                )
                apart = np.linalg.norm(surface[allowed] - seen.points[row, column], axis=1)
                yield (row, column), apart.min(initial=np.inf)


def test_matches_are_the_nearest_drawn_points_that_a_plain_search_allows(drawn, posed):
    context, term = drawn.context(posed), DataToSurface()
    residual = term.find(posed, context)
    plain = dict(find_plainly(drawn, context, term))
    place = {tuple(drawn.observation.points[at].astype(float)): at for at in plain}
    found = {place[tuple(target)]: n for n, target in enumerate(residual.targets)}
    assert len(found) == residual.count > 100, "each data point has one match at most"
    assert list(found) == sorted(found), "row by row"
    apart = np.linalg.norm(residual.points(posed) - residual.targets, axis=1)
    for at, nearest in plain.items():
        if at in found:
            assert apart[found[at]] == pytest.approx(nearest, abs=2e-4)  # the rings of pixels bound it across only
            assert apart[found[at]] < term.max_distance
        else:
            assert nearest > term.max_distance - 2e-4


def test_the_normal_is_that_of_the_face_that_was_met(drawn, posed):
    context = drawn.context(posed)
    residual = DataToSurface().find(posed, context)
    corners = posed.vertices[residual.ids]
    plain = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    np.testing.assert_allclose(residual.normals, plain / np.linalg.norm(plain, axis=1, keepdims=True), atol=1e-9)
    assert (residual.barycentric >= -1e-9).all()
    np.testing.assert_allclose(residual.barycentric.sum(axis=1), 1.0)
    towards = drawn.camera.T_world_camera[:3, 3] - residual.points(posed)
    assert (np.einsum("ni,ni->n", towards, residual.normals) > 0.0).all()


def test_nothing_farther_than_the_limit_or_of_another_label_is_met(drawn, posed):
    context = drawn.context(posed)
    short = DataToSurface(max_distance=0.002)
    residual = short.find(posed, context)
    assert 0 < residual.count < DataToSurface().find(posed, context).count
    assert np.linalg.norm(residual.points(posed) - residual.targets, axis=1).max() < 0.002
    foreign = replace(context, face_labels=np.full_like(context.face_labels, 4))
    assert DataToSurface().find(posed, foreign).count == 0


def test_surface_that_looks_another_way_is_not_met(drawn):
    posed = drawn.scene.pose_at(drawn.pose)
    context, seen = drawn.context(posed), drawn.observation
    turned = replace(context, observation=replace(seen, normals=-seen.normals))
    assert DataToSurface().find(posed, turned).count == 0
    assert DataToSurface(max_angle=180.0).find(posed, turned).count == DataToSurface().find(posed, context).count > 100


def test_data_without_a_normal_or_a_label_has_no_match(drawn, posed):
    context, seen = drawn.context(posed), drawn.observation
    for blank in ({"normals": np.zeros_like(seen.normals)}, {"labels": np.zeros_like(seen.labels)}):
        assert DataToSurface().find(posed, replace(context, observation=replace(seen, **blank))).count == 0


def test_at_the_true_pose_each_data_point_meets_its_own_pixel(drawn):
    posed = drawn.scene.pose_at(drawn.pose)
    residual = DataToSurface().find(posed, drawn.context(posed))
    assert np.linalg.norm(residual.points(posed) - residual.targets, axis=1).max() < 1e-5
    assert residual.linearize(posed).cost / residual.count < 0.001

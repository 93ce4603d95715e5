"""Contours of the drawn hand on edges of colour images."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import HAND, SCENE, look_from
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.geometry import se3
from tracker.model.ball import make_ball
from tracker.model.scene import Scene
from tracker.observation.image_edges import DIRECTIONS, ImageEdges, find_image_edges, sort_offsets
from tracker.rendering import render_view
from tracker.terms.contours import Contours, _find_into

VIEWS = [look_from(angle) for angle in (0.0, 0.8, 1.6)]


@pytest.fixture(scope="module")
def truth() -> np.ndarray:
    pose = SCENE.rest_pose()
    pose[6:] = curl_fingers(HAND, 0.2)
    T = se3.exp(np.array([0.0, 0.0, 0.0, 0.6, -0.4, 0.9]))
    T[:3, 3] -= (T @ np.append(SCENE.pose_at(pose).landmarks(0).mean(axis=0), 1.0))[:3]
    pose[:6] = se3.log(T @ se3.exp(pose[:6]))
    return pose


@pytest.fixture(scope="module")
def edges(truth) -> list[ImageEdges]:
    """Of a pale hand with dark lines between its parts, before a dark wall, through distorted lenses."""
    found = []
    for camera in VIEWS:
        posed = SCENE.pose_at(truth)
        view = render_view(posed, camera.K, camera.T_world_camera, camera.height, camera.width)
        towards = np.abs(view.face_normals[np.maximum(view.face, 0)] @ camera.T_world_camera[:3, 2])
        shaded = np.where(view.face >= 0, 90 + 140 * towards, 20).astype(np.uint8)
        columns, rows = np.meshgrid(np.arange(camera.width, dtype=float), np.arange(camera.height, dtype=float))
        ideal = camera.unproject(np.column_stack([columns.ravel(), rows.ravel()]))
        pixels = (ideal[:, :2] * camera.K[[0, 1], [0, 1]] + camera.K[:2, 2]).reshape(camera.height, camera.width, 2)
        image = cv2.remap(shaded, pixels.astype(np.float32), None, cv2.INTER_LINEAR)
        points = (posed.vertices - camera.T_world_camera[:3, 3]) @ camera.T_world_camera[:3, :3]
        points = points[:, :2] / points[:, 2:] * camera.K[[0, 1], [0, 1]] + camera.K[:2, 2]
        seen = find_image_edges(np.repeat(image[..., None], 3, axis=2), camera, points, 15.0)
        assert seen is not None
        found.append(seen)
    return found


def joint_error_mm(pose: np.ndarray, truth: np.ndarray) -> float:
    apart = SCENE.pose_at(pose).landmarks(0) - SCENE.pose_at(truth).landmarks(0)
    return 1000.0 * float(np.linalg.norm(apart, axis=1).mean())


def test_contours_in_three_views_bring_a_hand_back_to_where_it_is(truth, edges, rng):
    start = truth.copy()
    start[:3] += [0.003, -0.002, 0.003]
    start[6:] += rng.normal(0.0, 0.02, len(start) - 6)
    before = joint_error_mm(start, truth)
    terms = {f"view {number}": Contours(seen) for number, seen in enumerate(edges)}
    found = fit_frame(SCENE, None, start, start, Objective(terms=terms), FitOptions(iterations=15)).pose
    assert before > 4.0
    assert joint_error_mm(found, truth) < 1.5


def test_a_contour_meets_no_edge_that_runs_across_it_or_lies_too_far(truth, edges):
    posed = SCENE.pose_at(truth)
    assert Contours(edges[0]).find(posed).count > 100
    bits, half = edges[0].directions, DIRECTIONS // 2
    turned = replace(edges[0], directions=((bits << half) | (bits >> half)) & ((1 << DIRECTIONS) - 1))
    near = 0.0015
    along = Contours(edges[0], max_distance=near).find(posed).count
    assert Contours(turned, max_distance=near).find(posed).count < 0.3 * along


def test_what_is_measured_of_a_model_tells_where_it_is_from_where_it_is_not(truth, edges):
    away = truth.copy()
    away[:3] += [0.010, 0.0, 0.0]
    here, there = (
        np.concatenate([Contours(seen).measure(SCENE.pose_at(pose), 0) for seen in edges]) for pose in (truth, away)
    )
    assert np.mean(here < 0.002) > 0.9 > 0.5 > np.mean(there < 0.002)


def test_contours_of_chosen_models_pull_nothing_else(truth, edges):
    two = Scene((HAND, make_ball(0.03)))
    posed = two.pose_at(np.concatenate([truth, [0.0, 0.05, 0.0, 0.0, 0.0, 0.0]]))
    matched = Contours(edges[0], max_distance=0.1, models=(1,)).find(posed)
    assert matched.count > 10
    assert set(two.vertex_models[matched.ids].ravel()) == {1}


def test_the_lines_are_the_rays_of_the_matches_that_a_plain_loop_keeps(truth, edges):
    """Of each bone those within twice the root mean square of its distances, of the models that count."""
    two = Scene((HAND, make_ball(0.03)))
    posed = two.pose_at(np.concatenate([truth, [0.0, 0.05, 0.0, 0.0, 0.0, 0.0]]))
    for models in ((), (0,), (1,)):
        contours = Contours(edges[1], max_distance=0.02, models=models, weight=0.3)
        ids, shares, pixels, distances = contours._match(posed)
        counts = np.isfinite(distances) & np.isin(two.vertex_models[ids[:, 0]], models or (0, 1))
        bones, kept = two.arrays.weight_bones[ids[:, 0], 0], np.zeros(len(ids), bool)
        for bone in np.unique(bones[counts]):
            own = counts & (bones == bone)
            kept |= own & (distances <= 2.0 * np.sqrt(np.mean(distances[own] ** 2)))
        assert 0 < kept.sum() <= counts.sum()
        assert kept.sum() < counts.sum() or models == (1,)
        found = contours.find(posed)
        np.testing.assert_array_equal(found.ids, ids[kept])
        np.testing.assert_array_equal(found.barycentric, shares[kept])
        K, T = edges[1].K, edges[1].T_world_camera
        rays = np.column_stack([(pixels[kept] - K[:2, 2]) / K[[0, 1], [0, 1]], np.ones(kept.sum())]) @ T[:3, :3].T
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        np.testing.assert_allclose(found.directions, rays, atol=1e-12)
        np.testing.assert_allclose(found.moments, np.cross(T[:3, 3], rays), atol=1e-12)
        np.testing.assert_array_equal(found.weights, 0.3)


def test_the_kernel_finds_what_a_plain_loop_finds(truth, edges):
    posed, seen = SCENE.pose_at(truth), edges[1]
    height, width = seen.directions.shape
    view = render_view(posed, seen.K, seen.T_world_camera, height, width)
    count = np.count_nonzero(view.face >= 0)
    ids, shares = np.zeros((count, 3), np.int32), np.zeros((count, 3))
    pixels, apart = np.zeros((count, 2)), np.zeros(count)
    drawn = (view.face, view.inverse_depth, view.projected, posed.scene.arrays.faces)
    offsets = sort_offsets(64)
    how = (seen.K[0, 0], 1, 3, 0.008, 0.0008)
    found = _find_into(ids, shares, pixels, apart, drawn, (seen.directions, seen.places, offsets), how)
    plain = list(find_plainly(view, seen, 3, 0.008, 0.0008))
    assert found == len(plain) > 50
    np.testing.assert_allclose(apart[:found], [match[1] for match in plain], atol=1e-6)
    is_near = np.isfinite(apart[:found])
    assert 0.5 < is_near.mean() < 1.0
    np.testing.assert_allclose(pixels[:found][is_near], np.array([match[0] for match in plain])[is_near], atol=1e-4)
    surface = np.einsum("nc,nci->ni", shares[:found], posed.vertices[ids[:found]])
    here = (surface - seen.T_world_camera[:3, 3]) @ seen.T_world_camera[:3, :3]
    here = here[:, :2] / here[:, 2:] * seen.K[[0, 1], [0, 1]] + seen.K[:2, 2]
    np.testing.assert_allclose(here, [match[2] for match in plain], atol=1e-6)


def test_a_contour_pixel_that_gaps_surround_evenly_has_no_direction_and_no_match():
    inverse_depth = np.full((5, 5), 2.0)
    inverse_depth[[2, 3, 1], [3, 1, 0]] = 0.0  # what these three pixels say of the middle one's direction cancels
    face = np.full((5, 5), -1, np.int32)
    face[2, 2] = 0
    drawn = (face, inverse_depth, np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32))
    seen = (np.full((5, 5), 63, np.uint8), np.zeros((5, 5, 2), np.float32), sort_offsets(2))
    room = np.zeros((1, 3), np.int32), np.zeros((1, 3)), np.zeros((1, 2)), np.zeros(1)
    assert _find_into(*room, drawn, seen, (1.0, 1, 1, 0.008, 1.0)) == 0


def find_plainly(view, seen, stride, jump, max_distance):
    """Edge (column, row), distance, m, and contour pixel (column, row) of each contour pixel."""
    depth = np.where(view.face >= 0, view.depth, np.inf)
    height, width = depth.shape
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            if view.face[row, column] < 0 or (row + column) % stride:
                continue
            falls = depth > depth[row, column] + jump
            direction = np.zeros(2)
            for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
                direction += falls[row + dy, column + dx] * np.array([dx, dy])
            if not direction.any():
                continue
            for r in range(max(0, row - 2), min(height, row + 3)):
                for c in range(max(0, column - 2), min(width, column + 3)):
                    direction += 0.5 * falls[r, c] * np.array([c - column, r - row])
            place = int(np.arctan2(direction[1], direction[0]) % np.pi * DIRECTIONS / np.pi) % DIRECTIONS
            edges = seen.places[seen.directions & (1 << place) > 0][:, ::-1] - 0.5 * direction / np.linalg.norm(
                direction
            )
            apart = np.linalg.norm(edges - (column, row), axis=1) * depth[row, column] / seen.K[0, 0]
            nearest = int(np.argmin(apart))
            is_near = apart[nearest] <= max_distance
            yield tuple(edges[nearest]), apart[nearest] if is_near else np.inf, (column, row)


def test_a_scene_drawn_coarser_than_its_image_meets_the_same_edges(truth, edges):
    """An image of twice the resolution, of whose pixels four are drawn as one."""
    seen, K = edges[0], edges[0].K.copy()
    K[:2] *= 2.0
    K[:2, 2] += 0.5
    height, width = seen.directions.shape
    directions = np.zeros((2 * height, 2 * width), np.uint8)
    places = np.zeros((2 * height, 2 * width, 2), np.float32)
    there = 2.0 * seen.places[seen.directions > 0] + 0.5
    rows, columns = np.rint(there).astype(int).T
    directions[rows, columns], places[rows, columns] = seen.directions[seen.directions > 0], there
    posed = SCENE.pose_at(truth)
    T = seen.T_world_camera
    pixel = float(np.median((posed.vertices - T[:3, 3]) @ T[:3, 2])) / seen.K[0, 0]
    as_it_is = Contours(seen, stride=1, drawn=1.4 * pixel)._match(posed)
    finer = replace(seen, K=K, directions=directions, places=places)
    coarser = Contours(finer, stride=2, drawn=1.4 * pixel)._match(posed)
    np.testing.assert_array_equal(coarser[0], as_it_is[0])
    is_same = np.isclose(coarser[3], as_it_is[3], rtol=0.0, atol=0.2 * pixel)
    assert len(is_same) > 200 and is_same.mean() > 0.95  # two edges may have come to one pixel
    is_met = np.isfinite(as_it_is[3]) & np.isfinite(coarser[3])
    apart = np.linalg.norm(coarser[2][is_met] - 2.0 * as_it_is[2][is_met] - 0.5, axis=1)
    assert np.median(apart) < 1e-4 and np.percentile(apart, 90) < 1.0

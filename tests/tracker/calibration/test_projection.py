"""The camera's arithmetic against OpenCV's."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from tracker.calibration.projection import project_points, turn_vectors


@pytest.mark.parametrize("count", [0, 4, 5, 8, 12])
def test_points_fall_where_opencv_projects_them(count: int, rng: np.random.Generator) -> None:
    points = rng.normal(size=(50, 3)) * 0.2 + [0, 0, 1]
    K = np.array([[900.0, 0, 630], [0, 910.0, 350], [0, 0, 1]])
    distortion = np.zeros(12)
    distortion[:count] = 0.05 * rng.normal(size=count)
    theirs = cv2.projectPoints(points, np.zeros(3), np.zeros(3), K, distortion)[0][:, 0]
    assert np.allclose(project_points(points, K, distortion), theirs, atol=1e-9)


def test_a_point_behind_the_camera_has_a_large_and_finite_pixel() -> None:
    assert np.isfinite(project_points(np.array([[0.1, 0.1, -1.0]]), np.eye(3), np.zeros(12))).all()


def test_rotation_vectors_turn_as_opencvs_do_near_nothing_too(rng: np.random.Generator) -> None:
    vectors = np.concatenate([rng.normal(size=(9, 3)), 1e-9 * rng.normal(size=(3, 3)), np.zeros((1, 3))])
    theirs = np.array([cv2.Rodrigues(vector)[0] for vector in vectors])
    assert np.allclose(turn_vectors(vectors), theirs, atol=1e-12)

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree

from tracker.errors import TrackerError
from tracker.model.mirroring import MIRROR
from tracker.model.untrained_hand import untrained_hand
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, generate_truth
from tracker.synthesis.scans.pose_list import POSE_NAMES
from tracker.synthesis.scans.scanner import Scanner
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS, load_subject
from tracker.synthesis.scans.tissue import vertex_normals

STILL = ScanOptions(is_moved=False)


def distance_to(points, vertices, faces):
    """Signed (N,) distance of points to a fine surface, along the normal of the nearest vertex."""
    normals = vertex_normals(vertices, faces)
    _, nearest = KDTree(vertices).query(points)
    return np.einsum("nx,nx->n", points - vertices[nearest], normals[nearest])


def test_the_same_seed_makes_the_same_scan_and_another_one_another():
    first, again, other = (generate_scan(3, "tripod", seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(first.scan.points, again.scan.points)
    assert np.array_equal(first.true_vertices, again.true_vertices)
    assert not np.array_equal(first.true_vertices, other.true_vertices)


def test_a_scan_has_50000_points_that_err_by_the_noise_asked_for():
    scanner = Scanner(noise=0.2e-3)
    scan = generate_scan(5, "flat_spread", options=replace(STILL, scanner=scanner))
    assert scan.scan.points.shape == (50_000, 3)
    error = distance_to(scan.scan.points, *scan.true_surface)
    assert np.std(error) == pytest.approx(0.2e-3, rel=0.05)
    assert np.abs(np.linalg.norm(scan.scan.normals, axis=1) - 1.0).max() < 1e-12


def test_the_truth_is_that_of_the_scan_in_its_own_coordinates():
    scan = generate_scan(5, "half_curl", side="left", seed=4)
    truth = generate_truth(5, "half_curl", side="left", seed=4)
    a, b = (points - points.mean(axis=0) for points in (scan.true_vertices, truth.vertices))
    U, _, Vt = np.linalg.svd(a.T @ b)
    R = U @ Vt
    assert np.linalg.det(R) > 0.0
    assert np.abs(a @ R - b).max() < 1e-12
    assert np.abs(distance_to(scan.true_vertices, *scan.true_surface)).max() < 0.2e-3


def test_a_left_hand_is_the_mirror_image_of_the_right_one_in_the_same_pose():
    angles = np.full(31, 0.1)
    right, left = (generate_truth(7, angles, side) for side in ("right", "left"))
    assert np.array_equal(left.vertices, right.vertices * MIRROR)
    assert np.array_equal(left.joints, right.joints * MIRROR)
    outwards = vertex_normals(left.surface, left.surface_faces)
    assert np.allclose(outwards, vertex_normals(right.surface, right.surface_faces) * MIRROR)


def test_true_vertices_are_those_of_the_untrained_hand():
    truth = generate_truth(1, "flat_spread")
    model = untrained_hand("right")
    assert truth.vertices.shape == model.template.shape
    # The model's faces on the true vertices look outwards as its own do.
    own, true = (vertex_normals(v, model.faces) for v in (model.template, truth.vertices))
    assert np.mean(np.einsum("vx,vx->v", own, true) > 0.3) > 0.97


def test_training_and_test_subjects_are_37_different_people():
    meshes = [load_subject(number).vertices for number in (*TRAIN_SUBJECTS, *TEST_SUBJECTS)]
    assert len(TRAIN_SUBJECTS) == 31
    assert len(TEST_SUBJECTS) == 6
    for i, mesh in enumerate(meshes):
        for other in meshes[:i]:
            assert np.linalg.norm(mesh - other, axis=1).mean() > 1e-3


def test_there_are_51_poses_with_names_of_their_own():
    assert len(set(POSE_NAMES)) == 51


@pytest.mark.parametrize(
    "arguments", [(0, 0), (38, 0), (1, 51), (1, "nonsense"), (1, np.zeros(5)), (1, 0, "middle")], ids=str
)
def test_what_there_is_not_is_refused(arguments):
    with pytest.raises(TrackerError):
        generate_truth(*arguments)

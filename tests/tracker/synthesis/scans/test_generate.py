from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree

from tracker.errors import TrackerError
from tracker.model.mirroring import MIRROR
from tracker.model.untrained_hand import untrained_hand
from tracker.synthesis.scans.angles import pose_angles
from tracker.synthesis.scans.contact import find_depths
from tracker.synthesis.scans.deform import closed_volume, deform
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, generate_truth
from tracker.synthesis.scans.pose_list import FISTS, POSE_NAMES, POSES
from tracker.synthesis.scans.scanner import Scanner
from tracker.synthesis.scans.settle import settle
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS, load_subject, load_surface
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


def test_a_held_object_is_green_and_is_no_hand():
    scan = generate_scan(2, "power_sphere", options=ScanOptions(holds_object=True))
    assert scan.scan.colors is not None
    red, green, _ = scan.scan.colors.T.astype(int)
    is_object = green > np.maximum(red, 20)
    assert 0.1 < is_object.mean() < 0.7
    assert not (is_object & scan.is_hand).any()
    bare = generate_scan(2, "power_sphere")
    assert bare.scan.colors is not None
    assert not (bare.scan.colors[:, 1].astype(int) > np.maximum(bare.scan.colors[:, 0], 20)).any()


def test_without_forearm_nearly_all_points_are_hand():
    with_arm, without = (generate_scan(9, "fist", options=ScanOptions(has_forearm=has)) for has in (True, False))
    assert with_arm.is_hand.mean() < 0.93
    assert without.is_hand.mean() > 0.96
    for scan in (with_arm, without):
        # Truth reaches to the untrained hand's border: what is hand is near it.
        far = KDTree(scan.true_vertices).query(scan.scan.points[scan.is_hand])[0]
        assert np.percentile(far, 99.9) < 9e-3


def test_bending_a_finger_keeps_the_volume_and_a_fist_nearly():
    surface = load_surface()
    subject = load_subject(4)

    def volume(angles, strength=1.0):
        return closed_volume(deform(subject, angles, strength).vertices, surface.faces, surface.border)

    rest = volume(np.zeros(31))
    bent = pose_angles(subject, POSES[POSE_NAMES.index("index_bent")])
    fist = pose_angles(subject, POSES[POSE_NAMES.index("straight_fist")])
    assert abs(volume(bent) / rest - 1.0) < 0.02
    assert abs(volume(fist) / rest - 1.0) < 0.10
    assert abs(volume(fist) - rest) < 0.8 * abs(volume(fist, strength=0.0) - rest)


@pytest.mark.parametrize("pose", ["fist", "tip_pinch", "fist_thumb_inside", "flat_together"])
def test_no_part_of_a_hand_is_deep_inside_another(pose):
    surface, subject = load_surface(), load_subject(8)
    angles = settle(subject, pose_angles(subject, POSES[POSE_NAMES.index(pose)]), POSES[POSE_NAMES.index(pose)].touches)
    vertices = deform(subject, angles).vertices
    depth = find_depths(vertices, vertex_normals(vertices, surface.faces), subject.vertices)
    assert np.mean(depth > 1e-3) < 0.005


@pytest.mark.parametrize("pose", FISTS)
def test_the_fingers_of_a_fist_are_bent_back_to_their_knuckles(pose):
    fist, flat = (generate_truth(11, name).joints for name in (pose, "flat_together"))
    for first, last in ((1, 3), (4, 6), (7, 9), (10, 12)):
        assert np.linalg.norm(fist[last] - fist[first]) < 0.85 * np.linalg.norm(flat[last] - flat[first])


def test_people_differ_in_their_bones_as_people_do():
    def lengths(number):
        chains = load_subject(number).chains
        return np.concatenate([np.linalg.norm(np.diff(points, axis=0), axis=1) for points in chains.fingers.values()])

    ratios = np.array([lengths(number) / lengths(0) for number in (*TRAIN_SUBJECTS, *TEST_SUBJECTS)])
    assert 0.8 < ratios.min() < ratios.max() < 1.25
    relative = ratios / ratios.mean(axis=1, keepdims=True)
    assert np.all(relative.std(axis=0) > 0.015)
    assert np.all(relative.std(axis=0) < 0.05)

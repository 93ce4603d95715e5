"""A scan's own frame: however the scan lies, its points have the same coordinates, and its registration follows."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.registration.conftest import scan_model
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.hand_state import HandState
from tracker.registration.scan_frame import find_scan_frame
from tracker.synthesis.scans.generate import ScanOptions, generate_scan

ROTATIONS = Rotation.random(8, rng=np.random.default_rng(3)).as_matrix()
SHIFT = np.array([0.4, -0.2, 0.9])


@pytest.mark.parametrize("R", ROTATIONS[:3], ids=["1", "2", "3"])
def test_points_have_the_same_coordinates_however_the_scan_lies(own_scan, R):
    points = own_scan.scan.points
    turned = points @ R.T + SHIFT
    assert find_scan_frame(turned).enter(turned) == pytest.approx(find_scan_frame(points).enter(points), abs=1e-9)


def test_the_mirror_image_of_a_scan_has_mirrored_coordinates(own_scan):
    points = own_scan.scan.points
    mirrored = points @ np.diag([1.0, -1.0, 1.0]) @ ROTATIONS[0].T
    expected = find_scan_frame(points).enter(points) * [-1.0, 1.0, 1.0]
    assert find_scan_frame(mirrored).enter(mirrored) == pytest.approx(expected, abs=1e-9)


def test_the_frame_is_right_handed_along_the_principal_axes_and_points_lead_back(own_scan):
    points = own_scan.scan.points
    frame = find_scan_frame(points)
    inside = frame.enter(points)
    assert np.linalg.det(frame.R_scan_frame) == pytest.approx(1.0)
    assert frame.leave(inside) == pytest.approx(points, abs=1e-12)
    covariance = inside.T @ inside / len(inside)
    assert np.abs(covariance - np.diag(covariance.diagonal())).max() < 1e-12
    x, y, z = covariance.diagonal()
    assert x < z < y
    assert (inside[:, 1:] ** 3).sum(axis=0).min() >= 0.0


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_state_moves_with_the_hand_that_it_poses(own_scan, side):
    hand, rng = untrained_hand(), np.random.default_rng(1)
    frame = find_scan_frame(own_scan.scan.points)
    flip = np.array([1.0 if side == "right" else -1.0, 1.0, 1.0])
    state = HandState(0.4 * rng.normal(size=(16, 3)), rng.normal(size=hand.num_shape), rng.normal(size=3))
    moved = frame.leave_state(hand, state, side)
    expected = frame.leave(state.posed(hand).vertices * flip)
    assert moved.posed(hand).vertices * flip == pytest.approx(expected, abs=1e-9)
    assert frame.enter_state(hand, moved, side).posed(hand).vertices == pytest.approx(
        state.posed(hand).vertices, abs=1e-9
    )


def find_spread(scan, rotations, registrar) -> tuple[float, float]:
    """Largest difference of the mean distance, mm, and of any vertex, mm, among registrations of a turned scan."""
    means, vertices = [], []
    for R in rotations:
        turned = replace(scan, points=scan.points @ R.T + SHIFT, normals=scan.normals @ R.T)
        registration = registrar.register(turned)
        means.append(registration.scan_to_mesh_mm["mean"])
        vertices.append((registration.vertices - SHIFT) @ R)
    apart = np.linalg.norm(np.array(vertices) - vertices[0], axis=2).max()
    return max(means) - min(means), 1e3 * float(apart)


@pytest.mark.slow
def test_a_turned_scan_gives_the_turned_registration(registrar):
    spread, apart = find_spread(scan_model(2, 6000, (), "left").scan, ROTATIONS[:2], registrar)
    assert spread < 0.01 and apart < 0.2


@pytest.mark.slow
@pytest.mark.parametrize("subject", [2, 14])
def test_eight_rotations_of_a_thumb_on_the_little_finger_give_one_registration(subject, registrar):
    made = generate_scan(subject, "thumb_to_little", "right", 5, ScanOptions(strength=2.5))
    spread, apart = find_spread(made.scan, ROTATIONS, registrar)
    assert spread < 0.3 and apart < 1.0

"""Whole registrations: the right side and pose without help, and a clear verdict for what is no hand."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.registration.conftest import scan_model
from tracker.capture.scan import Scan
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.options import RegistrationOptions
from tracker.registration.register import Registrar
from tracker.registration.registration_files import pack_registration
from tracker.synthesis.scans.generate import ScanOptions, generate_scan


def find_errors(registration, own) -> np.ndarray:
    return np.linalg.norm(registration.vertices - own.vertices, axis=1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "folded", "side"),
    [
        (2, (), "left"),
        (3, ("middle", "ring", "little"), "right"),
        (4, ("index", "middle", "ring", "little"), "left"),
    ],
)
def test_a_hand_is_found_anywhere_in_any_pose_and_its_side_told(seed, folded, side, registrar):
    own = scan_model(seed, 6000, folded, side)
    registration = registrar.register(own.scan)
    assert registration.side == side
    assert find_errors(registration, own).mean() < 1e-3
    assert np.percentile(find_errors(registration, own), 95) < 2.5e-3
    assert registration.scan_to_mesh_mm["mean"] < 0.2
    assert registration.verdict == "good"


@pytest.fixture(scope="module")
def first(own_scan, registrar):
    return registrar.register(own_scan.scan, RegistrationOptions(side="right"))


def test_an_earlier_registration_is_a_start_that_leads_to_the_same_place_without_the_search(first, own_scan, registrar):
    again = registrar.register(own_scan.scan, start=first.as_start())
    assert np.linalg.norm(again.vertices - first.vertices, axis=1).mean() < 5e-4
    assert again.timings["start"] < 0.5 * first.timings["start"]


def test_a_mirrored_scan_gives_the_mirrored_registration(first, own_scan):
    mirrored = Registrar(untrained_hand("left")).register(own_scan.scan.mirrored(), RegistrationOptions(side="left"))
    assert (first.side, mirrored.side) == ("right", "left")
    apart = np.linalg.norm(mirrored.vertices * [-1.0, 1.0, 1.0] - first.vertices, axis=1)
    assert apart.mean() < 5e-4
    for registration in (first, mirrored):  # faces look outwards on both sides
        corners = registration.vertices[registration.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert np.einsum("fd,fd->", normals, corners.mean(axis=1) - registration.vertices.mean(axis=0)) > 0.0


def test_the_same_scan_gives_the_same_bytes(first, own_scan, registrar):
    again = registrar.register(own_scan.scan, RegistrationOptions(side="right"))
    same = replace(again, seconds=first.seconds, timings=first.timings)
    assert pack_registration(same) == pack_registration(first)


def test_the_model_vertices_are_those_of_pose_shape_and_translation(first):
    posed = untrained_hand().pose_at(first.pose, first.shape, first.translation)
    flip = np.array([1.0 if first.side == "right" else -1.0, 1.0, 1.0])
    assert posed.vertices * flip == pytest.approx(first.model_vertices, abs=1e-9)


def test_a_green_object_in_the_hand_is_left_out(own_scan, registrar):
    rng = np.random.default_rng(7)
    ball = rng.normal(size=(4000, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    middle = own_scan.vertices.mean(axis=0)
    points = np.concatenate([own_scan.scan.points, middle + 0.03 * ball])
    colors = np.zeros((len(points), 3), dtype=np.uint8)
    colors[:8000], colors[8000:] = (200, 150, 130), (40, 160, 50)
    scan = Scan(points, np.concatenate([own_scan.scan.normals, ball]), colors=colors)
    registration = registrar.register(scan, RegistrationOptions(side="right"))
    assert find_errors(registration, own_scan).mean() < 1e-3
    assert (
        np.isnan(registration.scan_to_mesh[8000:]).all() and np.isfinite(registration.scan_to_mesh[:8000]).mean() > 0.9
    )
    assert any("4000 green points" in reason for reason in registration.reasons)


def test_progress_is_told_in_order_and_what_it_raises_ends_the_work(own_scan, registrar):
    shares = []
    options = RegistrationOptions(side="right")
    registrar.register(own_scan.scan, options, progress=lambda stage, share: shares.append(share))
    assert shares == sorted(shares) and shares[-1] == 1.0 and len(shares) > 5

    def cancel(stage: str, share: float) -> None:
        if share > 0.1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        registrar.register(own_scan.scan, options, progress=cancel)


def make_sphere(radius: float, count: int = 4000) -> Scan:
    points = np.random.default_rng(0).normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    return Scan(radius * points, points.copy(), name="sphere")


def make_plate() -> Scan:
    rng = np.random.default_rng(1)
    points = np.concatenate([rng.uniform(-0.1, 0.1, (4000, 2)), np.zeros((4000, 1))], axis=1)
    return Scan(points, np.tile([0.0, 0.0, 1.0], (4000, 1)), name="plate")


def make_pieces() -> Scan:
    rng = np.random.default_rng(2)
    corners = rng.uniform(-0.1, 0.1, (1000, 1, 3)) + rng.uniform(-0.004, 0.004, (1000, 3, 3))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Scan(corners.reshape(-1, 3), np.repeat(normals, 3, axis=0), np.arange(3000).reshape(-1, 3), name="pieces")


@pytest.mark.slow
@pytest.mark.parametrize(
    "scan",
    [*(pytest.param(scan, marks=pytest.mark.slow) for scan in (make_sphere(0.06), make_plate())), make_pieces()],
    ids=lambda scan: scan.name,
)
def test_what_is_no_hand_is_never_called_good_and_takes_at_most_eight_times_as_long_as_a_hand(scan, registrar):
    began = time.process_time()
    registration = registrar.register(scan)
    assert registration.verdict == "bad" and registration.reasons
    assert np.isfinite(registration.vertices).all()
    given_up = time.process_time()
    registrar.register(scan_model(2, 6000, (), "left").scan)
    assert given_up - began < 8 * (time.process_time() - given_up)


@pytest.mark.parametrize(
    ("scan", "told"),
    [
        (make_sphere(10.0), "give its unit"),
        (make_sphere(0.001), "give its unit"),
        (Scan(np.full((100, 3), np.nan), np.zeros((100, 3))), "0 of 100 points"),
        (Scan(np.zeros((0, 3)), np.zeros((0, 3))), "0 of 0 points"),
        (make_sphere(0.08, 20), "20 of 20 points"),
    ],
    ids=["20 m", "2 mm", "NaN", "empty", "20 points"],
)
def test_nonsense_is_bad_at_once_with_the_reason(scan, told, registrar):
    registration = registrar.register(scan)
    assert registration.verdict == "bad" and told in registration.reasons[0]
    assert registration.seconds < 5.0 and np.isfinite(registration.vertices).all()
    assert len(registration.scan_to_mesh) == len(scan.points)


@pytest.mark.slow
def test_a_second_look_finds_the_arrangement_whose_finger_was_astray_in_the_first(registrar):
    made = generate_scan(9, "middle_bent", "left", 5007, ScanOptions(has_forearm=False))
    registration = registrar.register(made.scan)
    error = np.linalg.norm(registration.vertices - made.true_vertices, axis=1)
    assert registration.verdict == "good" and np.percentile(error, 95) < 0.004

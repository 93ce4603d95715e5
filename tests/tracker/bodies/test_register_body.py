"""Generated people are registered without a start, hands that are missing are said, and what is no person is bad."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.bodies.body_registration import load_body_registration, save_body_registration
from tracker.bodies.register_body import Registrar
from tracker.capture.scan import Scan
from tracker.errors import RegistrationError
from tracker.model.body_hands import body_hand
from tracker.model.body_model import body_model
from tracker.synthesis.bodies.generate import BODY_SCANNER, BodyScanOptions, generate_body, scan_person
from tracker.synthesis.bodies.person import make_person

SCANNER = replace(BODY_SCANNER, num_points=40_000, pixels=600)


@pytest.fixture(scope="module")
def registrar() -> Registrar:
    return Registrar(body_model())


@pytest.fixture(scope="module")
def made():
    return generate_body(1, 0, BodyScanOptions(SCANNER))


@pytest.fixture(scope="module")
def registered(registrar, made):
    stages: list[tuple[str, float]] = []
    found = registrar.register(made.scan, progress=lambda stage, share: stages.append((stage, share)))
    assert [share for _, share in stages] == sorted(share for _, share in stages) and stages[-1][0] == "judge"
    return found


def test_a_person_is_found_without_a_start_to_five_millimetres_and_both_hands_to_three(made, registered) -> None:
    apart = 1e3 * np.linalg.norm(registered.vertices - made.true_vertices, axis=1)
    assert apart.mean() < 5.0 and registered.verdict == "good" and registered.are_shown == (True, True)
    for side in ("left", "right"):
        ids = body_hand(body_model(), side).vertices
        assert apart[ids[made.is_seen[ids]]].mean() < 3.0, side
    assert 1e3 * registered.scan_to_mesh.mean() < 1.0


@pytest.mark.slow
def test_a_hand_that_is_not_in_the_scan_is_said_to_be_guessed_and_stays_at_the_arm(registrar, made, registered) -> None:
    person = make_person(1)
    rng = np.random.default_rng(4)
    shown = {"left": True, "right": False}
    translation = made.joints[0] - person.model.joints_of(person.rest)[0]
    other = scan_person(person, made.pose, translation, shown, SCANNER, rng, "without")
    found = registrar.register(other.scan, registered.state)
    assert found.are_shown == (True, False) and any("right hand is guessed" in reason for reason in found.reasons)
    wrist = body_hand(body_model(), "right").wrist
    assert np.abs(found.state.hands[1] - registered.state.hands[1]).max() < 0.1, "rad; held to what it was"
    assert np.linalg.norm(found.state.posed(body_model()).joints[wrist] - other.joints[wrist]) < 0.02


def test_a_registration_comes_back_from_the_disk_and_damaged_ones_are_refused(registered, tmp_path) -> None:
    save_body_registration(registered, body_model().faces, tmp_path)
    read = load_body_registration(tmp_path)
    assert np.array_equal(read.vertices, registered.vertices) and np.array_equal(read.state.pose, registered.state.pose)
    assert read.summary()["verdict"] == "good" and read.scan_digest == registered.scan_digest
    (tmp_path / "body.npz").write_bytes((tmp_path / "body.npz").read_bytes()[:5000])
    with pytest.raises(RegistrationError, match=r"body\.npz"):
        load_body_registration(tmp_path)


def test_a_person_scanned_twice_in_one_scan_is_called_bad_and_why(registrar, made, registered) -> None:
    aside = np.array([0.9, 0.0, 0.3])
    points = np.concatenate([made.scan.points, made.scan.points + aside])
    two = Scan(points, np.tile(made.scan.normals, (2, 1)), name="two")
    found = registrar.register(two, registered.state)
    assert found.verdict == "bad" and "another person or thing" in found.reasons[0]


def test_half_a_person_is_called_bad_and_why(registrar, made, registered) -> None:
    half = made.scan.select(made.scan.points[:, 1] > 0.75)
    found = registrar.register(half, registered.state)
    assert found.verdict == "bad" and any("part of a person" in reason for reason in found.reasons)

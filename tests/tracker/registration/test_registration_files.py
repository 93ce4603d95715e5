"""Registrations on the disk: to the last bit, and refused when damaged."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.capture.scan import load_scan
from tracker.errors import RegistrationError
from tracker.registration.registration import Registration
from tracker.registration.registration_files import (
    PLY_FILE,
    REGISTRATION_FILE,
    load_registration,
    save_registration,
    summarize_registration,
)


@pytest.fixture
def registration() -> Registration:
    rng = np.random.default_rng(0)
    distances = rng.uniform(0.0, 1e-3, 500).astype(np.float32).astype(np.float64)
    distances[::7] = np.nan
    return Registration(
        vertices=rng.uniform(-0.1, 0.1, (60, 3)),
        model_vertices=rng.uniform(-0.1, 0.1, (60, 3)),
        faces=rng.permutation(60).reshape(20, 3),
        pose=rng.normal(size=(16, 3)),
        shape=rng.normal(size=15),
        translation=rng.normal(size=3),
        side="left",
        verdict="doubtful",
        score=0.25,
        reasons=("Größe", "two"),
        scan_to_mesh=distances,
        seconds=1.5,
        timings={"start": 1.0},
        scan="a",
        scan_digest="d" * 64,
        model_digest="m" * 64,
        subject="s1",
        pose_name="fist",
        measures={"hidden": 0.1},
    )


def test_a_registration_comes_back_as_it_was_and_its_ply_is_a_mesh(registration, tmp_path):
    save_registration(registration, tmp_path / "a")
    for path in (tmp_path / "a", tmp_path / "a" / REGISTRATION_FILE):
        back = load_registration(path)
        for name, value in vars(registration).items():
            if isinstance(value, np.ndarray):
                assert np.array_equal(getattr(back, name), value, equal_nan=True), name
            else:
                assert getattr(back, name) == value, name
    assert len(load_scan(tmp_path / "a" / PLY_FILE).points) == 60


def test_equal_registrations_give_equal_bytes(registration, tmp_path):
    save_registration(registration, tmp_path / "a")
    save_registration(registration, tmp_path / "b")
    assert (tmp_path / "a" / REGISTRATION_FILE).read_bytes() == (tmp_path / "b" / REGISTRATION_FILE).read_bytes()


def test_the_summary_counts_only_the_points_of_the_hand(registration):
    summary = summarize_registration(registration)
    counted = registration.scan_to_mesh[np.isfinite(registration.scan_to_mesh)]
    assert summary["scan_to_mesh_mm"]["median"] == pytest.approx(1e3 * np.median(counted), abs=1e-4)
    assert summary["verdict"] == "doubtful" and summary["scan"] == "a"


DAMAGES = {
    "vertices": np.full((60, 3), np.nan),
    "model_vertices": np.zeros((59, 3)),
    "faces": np.full((20, 3), 60),
    "pose": np.zeros(48),
    "shape": np.array(["x"]),
    "translation": np.zeros(4),
    "side": np.array("both"),
    "verdict": np.array("splendid"),
    "score": np.array([1.0, 2.0]),
    "scan_to_mesh": np.full(500, np.inf),
    "details": np.array("{"),
    "scan": np.array("x" * 1000),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_a_damaged_array_is_refused(registration, tmp_path, name):
    save_registration(registration, tmp_path)
    with np.load(tmp_path / REGISTRATION_FILE) as arrays:
        fields = dict(arrays)
    np.savez(tmp_path / REGISTRATION_FILE, **(fields | {name: DAMAGES[name]}))
    with pytest.raises(RegistrationError, match=r"found .*; needed "):
        load_registration(tmp_path)
    del fields[name]
    np.savez(tmp_path / REGISTRATION_FILE, **fields)
    with pytest.raises(RegistrationError, match=f"no '{name}'"):
        load_registration(tmp_path)


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", b"x" * 100])
def test_what_is_no_npz_is_refused(tmp_path, data):
    (tmp_path / REGISTRATION_FILE).write_bytes(data)
    with pytest.raises(RegistrationError, match="damaged file"):
        load_registration(tmp_path)


def test_objects_in_an_npz_are_not_unpickled(registration, tmp_path):
    save_registration(registration, tmp_path)
    with np.load(tmp_path / REGISTRATION_FILE) as arrays:
        fields = dict(arrays)
    np.savez(tmp_path / REGISTRATION_FILE, **(fields | {"pose": np.array([print], dtype=object)}))
    with pytest.raises(RegistrationError, match="no 'pose'"):
        load_registration(tmp_path)

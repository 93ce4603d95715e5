"""A body's registration comes back from its file to the last bit, and a damaged one is refused."""

from pathlib import Path

import numpy as np
import pytest

from tracker.bodies.body_registration import (
    BODY_FILE,
    BodyRegistration,
    load_body_registration,
    pack_body_registration,
    save_body_registration,
)
from tracker.bodies.body_state import BodyState
from tracker.errors import RegistrationError

RNG = np.random.default_rng(0)
FOUND = BodyRegistration(
    vertices=RNG.normal(size=(9, 3)),
    model_vertices=RNG.normal(size=(9, 3)),
    state=BodyState(RNG.normal(size=(52, 3)), RNG.normal(size=4), RNG.normal(size=3), RNG.normal(size=(2, 6))),
    are_shown=(True, False),
    scan_to_mesh=RNG.random(20).astype(np.float32).astype(np.float64),
    verdict="doubtful",
    reasons=("the left hand is guessed",),
    measures={"shape": 1.5},
    seconds={"start": 2.0},
    scan="frame.ply",
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    save_body_registration(FOUND, np.array([[0, 1, 2]]), tmp_path)
    return tmp_path


def test_every_bit_comes_back(folder: Path) -> None:
    found = load_body_registration(folder)
    for name in ("vertices", "model_vertices", "scan_to_mesh"):
        np.testing.assert_array_equal(getattr(found, name), getattr(FOUND, name))
    for name in ("pose", "shape", "translation", "hands"):
        np.testing.assert_array_equal(getattr(found.state, name), getattr(FOUND.state, name))
    assert found.summary() == FOUND.summary() and found.measures == FOUND.measures
    assert pack_body_registration(found) == (folder / BODY_FILE).read_bytes()


@pytest.mark.parametrize(
    ("name", "array"),
    [
        ("vertices", np.full((9, 3), np.nan)),
        ("model_vertices", np.zeros((8, 3))),
        ("poses", np.zeros((1, 155))),
        ("hands", np.zeros((3, 6))),
        ("are_shown", np.zeros(3)),
        ("said", np.zeros(3)),
        ("said", np.array("{")),
    ],
)
def test_a_wrong_or_missing_array_is_refused(folder: Path, name: str, array: np.ndarray) -> None:
    with np.load(folder / BODY_FILE) as arrays:
        fields = dict(arrays)
    np.savez(folder / BODY_FILE, **{**fields, name: array})
    with pytest.raises(RegistrationError, match="needed"):
        load_body_registration(folder)
    del fields[name]
    np.savez(folder / BODY_FILE, **fields)
    with pytest.raises(RegistrationError, match=name):
        load_body_registration(folder)

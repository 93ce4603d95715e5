"""What is called good: also a person unlike all whom the model knows, but never a hand of the other side."""

import numpy as np
import pytest

from tests.tracker.registration.conftest import scan_model
from tracker.capture.scan import Scan
from tracker.registration.options import RegistrationOptions
from tracker.registration.verdict import (
    HIDDEN_MOST,
    LIMITS,
    OTHERS_MOST,
    STRANGE,
    STRANGE_MOST,
    TOLD,
    _is_sure_else,
    tell,
)


def swollen(scan: Scan, most: float) -> Scan:
    """The scan with smooth lumps and dents of up to so many m, which no shape direction of the model makes."""
    rng = np.random.default_rng(5)
    centers = scan.points[rng.choice(len(scan.points), 40, replace=False)]
    heights = most * rng.choice([-1.0, 1.0], 40)
    near = np.exp(-(np.linalg.norm(scan.points[:, None] - centers, axis=2) ** 2) / (2.0 * 0.012**2))
    return Scan(scan.points + (near @ heights)[:, None] * scan.normals, scan.normals, name="swollen")


def test_a_person_unlike_those_whom_the_model_knows_is_good_and_said_to_be_so(registrar):
    registration = registrar.register(swollen(scan_model(1, 6000).scan, 0.0024))
    assert (registration.side, registration.verdict) == ("right", "good")
    assert registration.reasons == (TOLD["person"],) and registration.score < 0.5
    assert any(registration.measures[name] > LIMITS[name] for name in STRANGE)


@pytest.mark.slow
def test_a_flat_hand_registered_as_one_of_the_other_side_is_not_good(own_scan, registrar):
    registration = registrar.register(own_scan.scan, RegistrationOptions(side="left"))
    assert registration.verdict != "good"


@pytest.mark.parametrize(
    ("change", "is_sure"),
    [
        ({}, True),
        ({"stretch": STRANGE_MOST + 0.01}, False),
        ({"moved": OTHERS_MOST + 0.01}, False),
        ({"scan_to_surface": OTHERS_MOST + 0.01}, False),
        ({"covered": 1.1}, False),
        ({"hidden_free": HIDDEN_MOST + 0.01}, False),
    ],
)
def test_nothing_else_may_speak_against_it(change, is_sure):
    shares = dict.fromkeys(LIMITS, 0.5) | {"stretch": 1.2, "scan_to_model": 1.3}
    hidden = change.pop("hidden_free", 0.01)
    assert _is_sure_else(shares | change, {"hidden_free": hidden}) == is_sure


def test_reasons_give_lengths_and_shares_not_squares():
    measures = {"scan_to_model": 2.25, "scan_to_surface": 0.09, "model_to_scan": 6.0, "hidden": 0.36, "shape": 2.0}
    told = [tell(fault, measures) for fault in ("scan_to_model", "scan_to_surface", "model_to_scan", "shape")]
    for text, figure in zip(told, ("1.5 mm", "0.30 mm", "36% of its vertices", "2.0 standard"), strict=True):
        assert figure in text

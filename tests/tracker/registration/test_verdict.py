"""What is called good: also a person unlike all whom the model knows, but never a hand of the other side."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.registration.conftest import OwnScan, scan_model
from tracker.capture.scan import Scan
from tracker.model.blend_limits import blend_limits
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.hand_state import HandState
from tracker.registration.measures import _find_hidden
from tracker.registration.options import RegistrationOptions
from tracker.registration.start_poses import FOLDED, STRAIGHT, curl_finger
from tracker.registration.verdict import LIMITS, TOLD, UNLIKE, tell


def swollen(own: OwnScan, most: float) -> Scan:
    """The scan with smooth lumps and dents of the palm, m, which no shape direction of the model makes."""
    rng = np.random.default_rng(5)
    palm = own.vertices[untrained_hand().skinning_weights[:, 0] > 0.9]
    heights = most * rng.choice([-1.0, 1.0], 40)
    away = np.linalg.norm(own.scan.points[:, None] - rng.choice(palm, 40, replace=False), axis=2)
    lumps = np.exp(-(away**2) / (2.0 * 0.012**2)) @ heights
    return Scan(own.scan.points + lumps[:, None] * own.scan.normals, own.scan.normals, name="swollen")


@pytest.mark.slow
def test_a_person_unlike_those_whom_the_model_knows_is_good_and_said_to_be_so(registrar):
    registration = registrar.register(swollen(scan_model(1, 6000), 0.003))
    assert (registration.side, registration.verdict) == ("right", "good")
    assert registration.reasons == (TOLD["person"],) and registration.score < 0.5
    assert registration.measures["scan_to_palm"] > UNLIKE * LIMITS["scan_to_palm"]


@pytest.mark.slow
def test_a_flat_hand_registered_as_one_of_the_other_side_is_not_good(own_scan, registrar):
    registration = registrar.register(own_scan.scan, RegistrationOptions(side="left"))
    assert registration.verdict != "good"


def test_a_folded_finger_and_the_palm_hide_one_another(registrar):
    fit, limits = registrar.fit, blend_limits(registrar.model)
    index = registrar.model.skinning_weights[fit.inner][:, 1:4].sum(axis=1) > 0.9
    palm = registrar.model.skinning_weights[fit.inner][:, 0] > 0.9
    hidden = {}
    for bend in (STRAIGHT, FOLDED):
        pose = curl_finger(limits, fit.neutral().pose, "index", bend)
        state = HandState(pose, fit.neutral().shape, fit.neutral().translation)
        hidden[bend] = _find_hidden(fit, fit.pose(state).vertices)
    assert hidden[FOLDED][index].mean() > 2.0 * hidden[STRAIGHT][index].mean()
    assert hidden[FOLDED][palm].mean() > 2.0 * hidden[STRAIGHT][palm].mean()


@pytest.mark.slow
def test_a_wrong_fingertip_shows_however_well_the_rest_of_the_hand_fits(own_scan, registrar):
    start = registrar.register(own_scan.scan).as_start()
    pose = curl_finger(blend_limits(registrar.model), start.pose, "ring", FOLDED)
    right = registrar.register(own_scan.scan, start=start)
    wrong = registrar.register(own_scan.scan, start=replace(start, pose=pose, vertices=None))
    assert (right.verdict, wrong.verdict) == ("good", "bad")
    assert wrong.measures["finger_to_scan"] > LIMITS["finger_to_scan"] > 2.0 * right.measures["finger_to_scan"]


def test_reasons_give_lengths_not_squares():
    measures = {"scan_to_finger": 2.25, "finger_to_scan": 4.0, "scan_to_palm": 6.25, "shape": 2.0}
    for (fault, _), figure in zip(measures.items(), ("1.5 mm", "2.0 mm", "2.5 mm", "2.0 standard"), strict=True):
        assert figure in tell(fault, measures)
    assert tell("side", measures) == TOLD["side"]

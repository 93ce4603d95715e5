"""Where a hand may be: best first, sides told, a finger astray found, nearly equal arrangements counted once."""

import numpy as np
import pytest

from tests.tracker.registration.conftest import scan_model
from tracker.model.blend_limits import blend_limits
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import ModelFit
from tracker.registration.scan_points import ScanPoints
from tracker.registration.start import APART, MORE, ROTATIONS, StartSearch, find_apart
from tracker.registration.start_poses import STRAIGHT, curl_finger
from tracker.registration.vertex_fit import fit_to_vertices


@pytest.fixture(scope="module")
def search():
    hand = untrained_hand()
    return StartSearch(ModelFit(hand, make_anatomical_prior(hand)), blend_limits(hand))


@pytest.fixture(scope="module")
def folded():
    return scan_model(4, 6000, ("middle",), "right")


@pytest.fixture(scope="module")
def found(search, folded):
    points = ScanPoints(folded.scan.points, folded.scan.normals)
    return search.find({"right": points, "left": points.mirrored()})


def test_the_best_comes_first_on_the_right_side_with_its_finger_folded(found, folded):
    assert [start.cost for start in found] == sorted(start.cost for start in found)
    assert found[0].side == "right"
    error = np.linalg.norm(found[0].evaluation.posed.vertices - folded.vertices, axis=1)
    assert np.percentile(error, 95) < 0.006


def test_a_finger_that_is_astray_is_found_by_starting_it_anew(search, folded):
    points = ScanPoints(folded.scan.points, folded.scan.normals)
    truth = fit_to_vertices(search.fit, search.fit.neutral(), folded.vertices)
    astray = HandState(curl_finger(search.limits, truth.pose, "middle", STRAIGHT), truth.shape, truth.translation)
    before = search._fit(astray, points.first(MORE), "right", ())
    after = search._try_fingers(points.first(MORE), before)
    tip = untrained_hand().tips[2]
    away = [np.linalg.norm(one.evaluation.posed.vertices[tip] - folded.vertices[tip]) for one in (before, after)]
    assert away[0] > 0.02, away
    assert away[1] < 0.005, away
    assert after.cost < before.cost


def test_of_arrangements_that_are_nearly_alike_the_first_stays(found):
    kept = find_apart([*found, *found])
    assert len(kept) == len(find_apart(found)) and kept[0] is found[0]
    for number, one in enumerate(kept):
        for other in kept[:number]:
            apart = np.linalg.norm(one.evaluation.posed.vertices - other.evaluation.posed.vertices, axis=1).max()
            assert one.side != other.side or apart > APART


def test_rotations_to_begin_with_are_all_different_and_none_is_a_mirror():
    assert len(ROTATIONS) == 48
    for number, R in enumerate(ROTATIONS):
        assert np.linalg.det(R) == pytest.approx(1.0)
        for other in ROTATIONS[:number]:
            assert (np.trace(R.T @ other) - 1.0) / 2.0 < np.cos(np.radians(30.0))


def test_growing_is_growing_in_all_directions(search):
    model = search.fit.model
    grown = model.shaped(0.05 * search.growth)
    root = search.roots[0]
    sizes = np.linalg.norm(grown - root, axis=1) / np.linalg.norm(model.template - root, axis=1)
    assert 1.0 < np.median(sizes) < 1.1

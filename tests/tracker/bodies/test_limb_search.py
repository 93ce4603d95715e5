"""A limb in a wrong place is begun anew and found; one in its place stays, and so does the rest of the body."""

from __future__ import annotations

from copy import copy

import numpy as np
import pytest

from tests.tracker.bodies.posed_bodies import A_POSE, LIMIT, MODEL, apart, points_of, scan_of, stand, turned
from tracker.bodies.body_prior import make_body_prior
from tracker.bodies.hand_mixture import default_mixture
from tracker.bodies.limb_search import FEW, LimbSearch, _starts
from tracker.model.mano_files import BODY_JOINTS
from tracker.registration.scan_points import ScanPoints


@pytest.fixture(scope="module")
def search() -> LimbSearch:
    return LimbSearch(MODEL, make_body_prior(), default_mixture())


def test_limbs_are_arms_and_legs_of_both_sides_and_share_no_vertex(search) -> None:
    own = [np.setdiff1d(np.arange(len(MODEL.template)), limb.rest) for limb in search.limbs]
    assert len(np.unique(np.concatenate(own))) == sum(map(len, own))
    middles = np.array([MODEL.template[ids].mean(axis=0) for ids in own])
    assert (np.sign(middles[:, 0]) == [1, -1, 1, -1]).all(), "the left is at +x"
    assert middles[:2, 1].min() > middles[2:, 1].max(), "arms are above legs"


def test_starts_of_the_right_side_are_the_mirror_images_of_the_lefts(search) -> None:
    for left, right in (search.limbs[:2], search.limbs[2:]):
        for mine, other in zip(_starts(left, stand()), _starts(right, stand()), strict=True):
            for a, b in zip(left.joints, right.joints, strict=True):
                assert np.allclose(mine.pose[a] * np.array([1.0, -1.0, -1.0]), other.pose[b], atol=1e-12)


@pytest.fixture(scope="module")
def left_arm(search) -> LimbSearch:
    """The same of one limb alone."""
    own = copy(search)
    own.limbs = search.limbs[:1]
    return own


def test_an_arm_that_was_thought_lowered_is_found_where_it_is_raised_ahead(left_arm) -> None:
    truth = stand(A_POSE + turned(left_shoulder=(0, -70, 35), left_elbow=(0, -40, 0)))
    found, changed = left_arm.improve(stand(), points_of(truth).first(3000))
    rest = left_arm.limbs[0].rest
    arm = np.setdiff1d(np.arange(len(MODEL.template)), rest)
    assert changed and apart(found, truth, arm) < 0.02 < 0.2 < apart(stand(), truth, arm), "m"
    assert apart(found, truth, rest) < 1e-4, "what was right stays"


def test_a_foot_that_is_folded_back_is_found_where_it_stands(search) -> None:
    truth, folded = stand(), stand(A_POSE + turned(right_ankle=(-108, 0, 0), right_foot=(34, 0, 0)))
    foot = np.flatnonzero(MODEL.skinning_weights.argmax(axis=1) == BODY_JOINTS.index("right_foot"))
    own = copy(search)
    own.limbs = search.limbs[3:]
    found, changed = own.improve(folded, points_of(truth).first(3000))
    assert changed and apart(found, truth, foot) < 0.02 < 0.15 < apart(folded, truth, foot), "m"


def test_a_limb_in_its_place_is_left_there(left_arm) -> None:
    found, changed = left_arm.improve(stand(), points_of(stand()).first(3000))
    assert not changed and apart(found, stand()) < 3 * LIMIT


def test_a_limb_that_the_scan_hardly_shows_is_not_looked_for(search) -> None:
    scan = scan_of(stand())
    trunk = np.flatnonzero((np.abs(scan.points[:, 0]) < 0.12) & (scan.points[:, 1] > scan.points[:, 1].mean()))
    few = ScanPoints(scan.points[trunk], scan.normals[trunk])
    assert all(len(search._points_of(limb, stand(), few).points) < FEW for limb in search.limbs)
    found, changed = search.improve(stand(), few)
    assert not changed and np.array_equal(found.pose, stand().pose)

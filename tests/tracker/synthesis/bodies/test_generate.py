"""Generated scans of people are the same every time, lie on their truth, and miss the hands they should miss."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree

from tracker.registration.surface_search import SurfaceSearch
from tracker.synthesis.bodies.body_poses import a_pose, is_entangled
from tracker.synthesis.bodies.generate import BODY_SCANNER, BodyScanOptions, generate_body
from tracker.synthesis.bodies.person import hand_vertices, make_person

SCANNER = replace(BODY_SCANNER, num_points=8000, views=6, pixels=400)


@pytest.fixture(scope="module")
def scanned():
    return generate_body(1, 0, BodyScanOptions(SCANNER, missing_hands=1.0))


def test_a_scan_is_the_same_every_time_and_another_seed_another_one(scanned) -> None:
    again = generate_body(1, 0, BodyScanOptions(SCANNER, missing_hands=1.0))
    assert np.array_equal(scanned.scan.points, again.scan.points)
    assert not np.array_equal(scanned.pose, generate_body(1, 1, BodyScanOptions(SCANNER)).pose)


def test_points_lie_on_the_true_surface_but_for_the_noise_and_normals_look_out(scanned) -> None:
    model = make_person(1).model
    search = SurfaceSearch(scanned.true_vertices, model.faces)
    found = search.match(scanned.true_vertices, scanned.scan.points, scanned.scan.normals, 0.02)
    assert np.mean(found.faces >= 0) > 0.995
    assert 0.3e-3 < np.std(found.offsets) < 0.8e-3, "the scanner's noise is 0.5 mm"
    assert len(scanned.scan.points) == 8000 and scanned.scan.points[:, 1].min() > -0.01, "the floor is at y = 0"


def test_hands_that_are_missing_give_no_points(scanned) -> None:
    assert scanned.shows_hand == {"left": False, "right": False}
    tree = KDTree(scanned.scan.points)
    for side, ids in hand_vertices(make_person(1).model).items():
        tips = make_person(1).model.tips[:5] if side == "right" else make_person(1).model.tips[5:]
        assert tree.query(scanned.true_vertices[tips])[0].min() > 0.01 and len(ids) == 782


def test_an_arm_in_the_trunk_is_noticed() -> None:
    person = make_person(2)
    pose = a_pose()
    assert not is_entangled(person, pose)
    pose[16, 2] = np.radians(-105.0)
    assert is_entangled(person, pose)

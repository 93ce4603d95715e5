"""A hand is found in a depth image of which nothing is known, and the hypotheses cover all that a palm can do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import CAMERA, palm_to_camera, photograph
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.finger_search import measure_curl
from tracker.fitting.region import depth_range
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.observation import Preprocessing
from tracker.search.palm_candidates import PalmCandidate
from tracker.search.start_automatic import STEP, Found, Search, find_hand, propose_poses

HANDS = {"right": default_hand("right"), "left": default_hand("left")}
HAND = HANDS["right"]
SCENE = Scene((HAND,))
HOW = Preprocessing(bilateral_diameter=0)
QUICK = Search(candidates=4, turns=8, curls=(0.0,), rigid=16, rough=4, bent=0, fine=1)
PLACE = (0.03, 0.02, 0.45)


@pytest.fixture(params=list(HANDS))
def hand(request) -> ArticulatedModel:
    return HANDS[request.param]


def find(frame: Frame, model: ArticulatedModel, camera: Camera = CAMERA, **options) -> Found | None:
    return find_hand(frame, camera, model, HOW, *depth_range(frame), **{"search": QUICK, **options})


def joints_of(model: ArticulatedModel, pose: np.ndarray) -> np.ndarray:
    return Scene((model,)).pose_at(pose).landmarks(0)


def test_an_open_hand_before_nothing_is_found_where_it_is(hand):
    pose = palm_to_camera(hand, PLACE)
    found = find(photograph(Scene((hand,)), pose), hand)
    assert found is not None
    assert found.quality.agrees and found.quality.score > 0.9
    assert np.linalg.norm(joints_of(hand, found.pose) - joints_of(hand, pose), axis=1).mean() < 6e-3


def test_a_hand_is_found_wherever_in_the_world_its_camera_stands():
    T = se3.exp(np.array([0.4, 1.0, -2.0, 0.5, -1.2, 2.0]))
    pose = palm_to_camera(HAND, PLACE)
    frame = photograph(SCENE, pose)
    found = find(frame, HAND, replace(CAMERA, T_world_camera=T))
    assert found is not None
    expected = se3.transform(T, joints_of(HAND, pose))
    assert np.linalg.norm(joints_of(HAND, found.pose) - expected, axis=1).mean() < 6e-3


def test_each_hand_is_explained_best_by_its_own_side():
    for side, other in (("right", "left"), ("left", "right")):
        frame = photograph(Scene((HANDS[side],)), palm_to_camera(HANDS[side], PLACE, 0.3))
        own, wrong = find(frame, HANDS[side]), find(frame, HANDS[other])
        assert own is not None
        assert wrong is None or own.quality.merit > wrong.quality.merit


def test_of_two_hands_the_nearer_one_is_taken_whichever_side_of_the_image_it_is_on():
    scene = Scene((HAND, HAND))
    for aside in (-0.1, 0.1):
        near, far = palm_to_camera(HAND, (aside, 0.0, 0.45)), palm_to_camera(HAND, (-1.3 * aside, 0.0, 0.6))
        found = find(photograph(scene, np.r_[far, near]), HAND)
        assert found is not None
        assert np.linalg.norm(joints_of(HAND, found.pose) - joints_of(HAND, near), axis=1).mean() < 0.01


def test_in_an_empty_image_there_is_no_hand_and_on_a_bare_wall_none_to_believe():
    empty = replace(photograph(SCENE, palm_to_camera(HAND, PLACE)), depth=np.zeros((240, 320), np.float32))
    assert find(empty, HAND) is None
    wall = find(replace(empty, depth=np.full((240, 320), 0.5, np.float32), is_hand=None), HAND)
    assert wall is None or not wall.quality.agrees


def test_nothing_outside_of_the_depths_is_looked_at():
    frame = photograph(SCENE, palm_to_camera(HAND, PLACE))
    for near, far in ((0.6, 3.0), (0.1, 0.3)):
        assert find_hand(frame, CAMERA, HAND, HOW, near, far, QUICK) is None


def test_no_hypothesis_is_no_hand_and_the_parts_together_hold_the_best():
    frame = photograph(SCENE, palm_to_camera(HAND, PLACE))
    assert find(frame, HAND, part=slice(0, 0)) is None
    parts = [find(frame, HAND, search=replace(STEP, candidates=4), part=slice(step, None, 8)) for step in range(8)]
    assert max(part.quality.merit for part in parts if part is not None) > 1.0


@pytest.fixture
def candidate() -> PalmCandidate:
    normal = np.array([0.3, -0.2, -1.0])
    return PalmCandidate(np.array([0.05, 0.02, 0.5]), normal / np.linalg.norm(normal))


def test_hypotheses_have_the_palm_at_the_place_flat_on_its_surface_to_all_sides_with_either_face(hand, candidate):
    search = Search(turns=12)
    poses = propose_poses(Scene((hand,)), candidate, CAMERA, search)
    assert len(poses) == 12 * 2 * len(search.curls)
    joints = np.array([joints_of(hand, pose) for pose in poses])
    palms = 0.45 * joints[:, 0] + 0.55 * joints[:, 9]
    assert np.linalg.norm(palms - candidate.point, axis=1).max() < 0.015
    assert np.all((palms - candidate.point) @ candidate.point > 0), "the bones are behind the skin"
    forward = joints[:, 9] - joints[:, 0]
    assert np.abs(forward @ candidate.normal).max() < 1e-9
    out = np.cross(forward, joints[:, 5] - joints[:, 17]) @ candidate.normal
    assert np.count_nonzero(out > 0) == np.count_nonzero(out < 0) == len(poses) // 2
    unit = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    one_way = unit[:12]
    np.testing.assert_allclose(one_way.sum(axis=0), 0.0, atol=1e-9)  # evenly around
    curls = [measure_curl(hand, pose[6:]) for pose in poses]
    assert sorted(set(np.round(curls, 6))) == sorted(search.curls)


def test_hypotheses_turn_with_the_camera_and_the_place(candidate):
    T = se3.exp(np.array([0.3, -1.0, 0.5, 0.4, 2.0, -1.0]))
    there = PalmCandidate(se3.transform(T, candidate.point[None])[0], T[:3, :3] @ candidate.normal)
    search = Search(turns=5)
    here = propose_poses(SCENE, candidate, CAMERA, search)
    moved = propose_poses(SCENE, there, replace(CAMERA, T_world_camera=T), search)
    for one, other in zip(here, moved, strict=True):
        np.testing.assert_allclose(joints_of(HAND, other), se3.transform(T, joints_of(HAND, one)), atol=1e-9)


@pytest.mark.parametrize("normal", [(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
def test_a_surface_that_is_seen_edge_on_from_the_side_has_hypotheses_like_any_other(normal):
    for tilt in (0.0, 1e-12, 1e-3):
        tilted = np.add(normal, (0.0, tilt, 0.0)) / np.hypot(1.0, tilt)
        poses = propose_poses(SCENE, PalmCandidate(np.array([0.3, 0.0, 0.4]), tilted), CAMERA, Search(turns=4))
        joints = np.array([joints_of(HAND, pose) for pose in poses])
        assert np.abs((joints[:, 9] - joints[:, 0]) @ tilted).max() < 1e-6

"""A scene is fitted to what several views saw, whichever comes first, and believed where two of them agree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import look_from
from tracker.capture.camera import Camera
from tracker.capture.frame import CameraFrame, Frame
from tracker.fitting.depth_view import DepthView
from tracker.fitting.finger_search import curl_fingers
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import ViewHands
from tracker.fitting.view_hold import MANY
from tracker.geometry import se3
from tracker.landmarks import DetectedHand
from tracker.model.default_hand import default_hand
from tracker.model.scene import PosedScene
from tracker.observation import undistort
from tracker.rendering import render_view
from tracker.terms.marked_joints import MarkedJoints
from tracker.tracking.fit_views import (
    BESIDE_JOINTS,
    compose_near,
    fit_views,
    judge_hand,
    leave_to_depth,
)

HAND = default_hand("right")
CAMERAS = tuple(look_from(angle) for angle in (0.0, 0.8, 1.6))
SETUP = TrackSetup(
    ("right",), (HAND,), CAMERAS[0].id, TrackOptions(calibrate=False), view_ids=tuple(c.id for c in CAMERAS)
)
SCENE = SETUP.scene
NOTHING = Objective({})


@pytest.fixture(scope="module")
def pose() -> np.ndarray:
    """(D,) a half-closed hand about the origin."""
    bent = np.r_[np.zeros(6), curl_fingers(HAND, 0.4)]
    bent[:3] -= SCENE.pose_at(bent).landmarks(0).mean(axis=0)
    return bent


def see(pose: np.ndarray, cameras=CAMERAS) -> ViewHands:
    """What a detector without noise tells of a hand."""
    joints = SCENE.pose_at(pose).landmarks(0)
    return ViewHands(
        tuple(cameras), tuple({"right": DetectedHand(c.project(joints), np.zeros((21, 3)), 1.0, 1.0)} for c in cameras)
    )


def blank(cameras=CAMERAS) -> list[CameraFrame]:
    """Images in which nothing is."""
    return [CameraFrame(c, Frame(0, c.id, np.full((480, 640, 3), 60, np.uint8), None)) for c in cameras]


def with_depth(pose: np.ndarray, camera: Camera) -> CameraFrame:
    """A view that measures the hand's depth, as an ideal camera sees it."""
    ideal = undistort(Frame(0, camera.id, None, np.zeros((480, 640), np.float32)), camera)[1]
    drawn = render_view(SCENE.pose_at(pose), ideal.K, ideal.T_world_camera, 480, 640)
    return CameraFrame(ideal, Frame(0, camera.id, None, drawn.depth.astype(np.float32)))


def joint_error(pose: np.ndarray, truth: np.ndarray) -> float:
    """Mean, m."""
    one, other = (SCENE.pose_at(each).landmarks(0) for each in (pose, truth))
    return float(np.linalg.norm(one - other, axis=1).mean())


@pytest.fixture(scope="module")
def start(pose) -> np.ndarray:
    """A pose 2 cm and a fifth of a radian off."""
    return SCENE.retract(pose, np.r_[0.015, -0.01, 0.008, 0.1, -0.15, 0.1, np.full(HAND.num_dofs - 6, 0.1)])


@pytest.mark.parametrize("views", [1, 2, 3, MANY])
def test_a_hand_comes_to_the_joints_that_its_views_saw(pose, start, views):
    cameras = [look_from(angle) for angle in np.linspace(0.0, 1.6, views)]
    fit = fit_views(SETUP, NOTHING, see(pose, cameras), blank(cameras), start, 10)
    assert joint_error(start, pose) > 0.015
    assert joint_error(fit.pose, pose) < (0.03 if views == 1 else 0.003)
    seen = [
        np.abs(c.project(SCENE.pose_at(fit.pose).landmarks(0)) - p["right"].points)
        for c, p in zip(cameras, see(pose, cameras).hands, strict=True)
    ]
    assert np.mean(seen) < 2.0  # px


def test_which_view_comes_first_does_not_matter(pose, start):
    order = [2, 0, 1]
    cameras = [CAMERAS[place] for place in order]
    one = fit_views(SETUP, NOTHING, see(pose), blank(), start, 6)
    other = fit_views(SETUP, NOTHING, see(pose, cameras), blank(cameras), start, 6)
    np.testing.assert_allclose(other.pose, one.pose, atol=1e-6)


def test_where_no_view_saw_anything_the_pose_stays(pose):
    nobody = ViewHands(CAMERAS, ({}, {}, {}))
    fit = fit_views(SETUP, NOTHING, nobody, blank(), pose, 4)
    np.testing.assert_allclose(fit.pose[:6], pose[:6], atol=1e-9)
    assert joint_error(fit.pose, pose) < 2e-3, "joints may leave their limits' edges, no more"


@pytest.mark.parametrize(
    ("right_views", "is_held", "is_followed"),
    [((0, 1, 2), True, True), ((0, 2), True, True), ((1,), False, True), ((), False, False)],
)
def test_two_views_must_agree_with_a_hand_and_one_is_enough_to_follow_it_on(pose, right_views, is_held, is_followed):
    there, elsewhere = see(pose), see(pose + np.r_[0.2, 0.1, 0.0, np.zeros(HAND.num_dofs - 3)])
    mixed = tuple((there if view in right_views else elsewhere).hands[view] for view in range(3))
    for hands in (mixed, tuple(hand if view in right_views else {} for view, hand in enumerate(mixed))):
        verdict = judge_hand(SETUP, ViewHands(CAMERAS, hands), SCENE.pose_at(pose), 0)
        assert verdict == (is_held, is_followed)


def test_one_view_is_enough_where_the_hand_is_outside_of_all_others(pose):
    turned = [replace(c, T_world_camera=c.T_world_camera @ np.diag([-1.0, 1.0, -1.0, 1.0])) for c in CAMERAS[1:]]
    seen = ViewHands((CAMERAS[0], *turned), (see(pose).hands[0], {}, {}))
    assert judge_hand(SETUP, seen, SCENE.pose_at(pose), 0) == (True, True)
    alone = ViewHands(CAMERAS[:1], see(pose).hands[:1])
    assert judge_hand(SETUP, alone, SCENE.pose_at(pose), 0) == (True, True)


def test_a_hand_outside_of_all_images_is_not_believed_whatever_was_seen(pose):
    beside = pose + np.r_[1.0, np.zeros(HAND.num_dofs - 1)]
    seen = see(beside, CAMERAS[:1])
    assert judge_hand(SETUP, seen, SCENE.pose_at(beside), 0) == (False, True)


def test_views_with_depth_that_show_the_scene_have_a_term_each_and_the_joints_stay(pose):
    away = replace(CAMERAS[2], T_world_camera=se3.exp(np.array([5.0, 0, 0, 0, 0, 0])))
    views = [with_depth(pose, CAMERAS[0]), *blank(CAMERAS[1:2]), with_depth(pose, away)]
    near = compose_near(NOTHING, SETUP, see(pose, CAMERAS[1:2]), views, SCENE.pose_at(pose))
    assert set(near.terms) == {"joints_right", f"depth_{CAMERAS[0].id}"}
    depth = near.terms[f"depth_{CAMERAS[0].id}"]
    assert isinstance(depth, DepthView)
    for name, term in Objective().terms.items():
        assert depth.terms[name].weight == pytest.approx(BESIDE_JOINTS * term.weight)


def settled(pose: np.ndarray, posed: PosedScene, *cameras: Camera) -> Objective | None:
    views = [with_depth(pose, camera) for camera in cameras]
    seen = see(pose, CAMERAS[2:])
    return leave_to_depth(compose_near(NOTHING, SETUP, seen, views, SCENE.pose_at(pose)), posed)


def test_a_hand_that_the_depth_settles_needs_no_joints_and_one_that_any_depth_contradicts_keeps_them(pose):
    left = settled(pose, SCENE.pose_at(pose), *CAMERAS[:2])
    assert left is not None and len(left.terms) == 2
    assert not any(isinstance(term, MarkedJoints) for term in left.terms.values())
    for depth in left.terms.values():
        assert isinstance(depth, DepthView)
        assert {name: term.weight for name, term in depth.terms.items()} == {
            name: term.weight for name, term in Objective().terms.items()
        }
    fist = np.r_[pose[:6], curl_fingers(HAND, 0.9)]
    assert settled(pose, SCENE.pose_at(fist), *CAMERAS[:2]) is None
    assert settled(pose, SCENE.pose_at(pose)) is None, "without depth nothing is settled by it"

"""What is measured of a drawn hand: the same from wherever one looks, in metres, with others and hidden parts apart."""

from __future__ import annotations

from dataclasses import astuple, replace

import numpy as np
import pytest

from tests.tracker.scenes import CAMERA, move_pose, palm_to_camera, photograph
from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.finger_search import curl_fingers, list_finger_angles
from tracker.fitting.frame_fit import draw
from tracker.fitting.measure_quality import ALIKE, CUT, RIM, measure_quality
from tracker.fitting.quality import MISFIT, SHOWN, Quality
from tracker.fitting.region import whole_image
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS
from tracker.model.scene import Scene
from tracker.observation import Observation, Preprocessing, observe

RIGHT, LEFT = default_hand("right"), default_hand("left")
SCENE = Scene((RIGHT,))
POSE = palm_to_camera(RIGHT, (0.0, 0.0, 0.45))
FOCAL = float(CAMERA.K[0, 0])


def see(frame: Frame, camera: Camera = CAMERA) -> Observation:
    return observe(frame, camera, whole_image(camera, 0.1, 3.0), Preprocessing(bilateral_diameter=0))


def judge(frame: Frame, pose: np.ndarray = POSE, scene: Scene = SCENE, model: int = 0, camera: Camera = CAMERA):
    seen = see(frame, camera)
    return measure_quality(draw(scene.pose_at(pose), seen), seen, model)


def numbers(quality: Quality) -> np.ndarray:
    """Its measures, those of a detector apart."""
    return np.array(astuple(quality)[:9], dtype=np.float64)


def paint(frame: Frame, where, depth: float, is_hand: bool) -> Frame:
    """The frame with some pixels of a hand or of another thing at a depth, m; 0 for none."""
    assert frame.depth is not None and frame.is_hand is not None
    painted, labels = frame.depth.copy(), frame.is_hand.copy()
    painted[where], labels[where] = depth, is_hand
    return replace(frame, depth=painted, is_hand=labels)


def test_of_the_pose_that_was_drawn_everything_is_explained_and_nothing_is_left():
    quality = judge(photograph(SCENE, POSE))
    assert (quality.inside, quality.explained, quality.silhouette_iou, quality.coverage) == (1.0, 1.0, 1.0, 1.0)
    assert quality.score > 1.0 - 1e-5 and quality.depth_residual < 1e-7
    assert quality.misfit == quality.broad_misfit == 0.0
    assert not quality.is_lost


def test_hand_and_camera_moved_together_are_measured_alike():
    wrong = SCENE.retract(POSE, np.r_[0.006, 0.004, 0.003, 0.0, 0.1, 0.1, np.full(RIGHT.num_dofs - 6, 0.1)])
    T = se3.exp(np.array([0.4, 1.0, -2.0, 0.5, -1.2, 2.0]))
    there = replace(CAMERA, T_world_camera=T)
    here = judge(photograph(SCENE, POSE), wrong)
    moved = judge(photograph(SCENE, move_pose(SCENE, T, POSE), there), move_pose(SCENE, T, wrong), camera=there)
    np.testing.assert_allclose(numbers(moved), numbers(here), rtol=0.02, atol=2e-6)
    assert 0.0 < here.score < 0.95


def test_which_hand_of_a_scene_comes_first_changes_nothing():
    poses = {"right": palm_to_camera(RIGHT, (-0.06, 0.0, 0.45)), "left": palm_to_camera(LEFT, (0.06, 0.0, 0.5), 0.4)}
    one, other = Scene((RIGHT, LEFT)), Scene((LEFT, RIGHT))
    first, second = np.r_[poses["right"], poses["left"]], np.r_[poses["left"], poses["right"]]
    frame = photograph(one, np.r_[poses["right"], palm_to_camera(LEFT, (0.06, 0.01, 0.5), 0.2)])
    for hand in (0, 1):
        assert judge(frame, first, one, hand) == judge(frame, second, other, 1 - hand)


def test_a_hand_that_stands_elsewhere_and_is_explained_says_nothing_of_this_one():
    both = Scene((RIGHT, LEFT))
    pose = np.r_[palm_to_camera(RIGHT, (-0.08, 0.0, 0.45), 0.3), palm_to_camera(LEFT, (0.08, 0.0, 0.45))]
    wrong = both.retract(pose, np.r_[np.full(6, 0.01), np.full(RIGHT.num_dofs - 6, 0.1), np.zeros(LEFT.num_dofs)])
    alone = judge(photograph(SCENE, pose[: RIGHT.num_dofs]), wrong[: RIGHT.num_dofs])
    beside = judge(photograph(both, pose), wrong, both)
    np.testing.assert_allclose(numbers(beside), numbers(alone), rtol=1e-6)
    assert judge(photograph(both, pose), wrong[: RIGHT.num_dofs]).explained < alone.explained - 0.2


@pytest.mark.parametrize("shift", [0.0, 0.3 * ALIKE, 0.95 * ALIKE, 1.05 * ALIKE, 0.95 * CUT, 1.5 * CUT])
def test_depth_that_is_off_agrees_up_to_a_limit_and_costs_in_proportion_up_to_another(shift):
    frame = photograph(SCENE, POSE)
    assert frame.depth is not None
    quality = judge(replace(frame, depth=np.where(frame.depth > 0, frame.depth + np.float32(shift), np.float32(0.0))))
    assert quality.inside == quality.explained == float(shift < ALIKE)
    assert quality.depth_residual == pytest.approx(shift, abs=1e-6)
    assert quality.score == pytest.approx(1.0 - min(shift / CUT, 1.0), abs=1e-4)


@pytest.mark.parametrize("distance", [0.3, 0.6, 0.9])
def test_what_shows_of_a_hand_is_measured_in_metres_however_far_away_it_is(distance):
    def area(distance: float) -> float:
        pose = palm_to_camera(RIGHT, (0.0, 0.0, distance))
        return judge(photograph(SCENE, pose), pose).area

    assert area(distance) == pytest.approx(area(0.45), rel=0.06)
    assert 0.008 < area(distance) < 0.02  # the palm side of a grown-up's hand, m²


def test_what_a_nearer_thing_hides_is_no_fault_but_no_evidence_either():
    whole = photograph(SCENE, POSE)
    covered = judge(paint(whole, np.s_[:150, :], 0.3, False))
    assert covered.inside == covered.explained == 1.0
    assert covered.misfit == 0.0 and covered.score > 0.999
    assert SHOWN < covered.area < 0.5 * judge(whole).area
    hidden = judge(paint(whole, np.s_[:, :], 0.3, False))
    assert hidden.area == 0.0 and hidden.is_gone


def test_where_something_farther_is_seen_through_a_drawn_finger_the_finger_is_elsewhere():
    whole = photograph(SCENE, POSE)
    for behind in (paint(whole, np.s_[:70, :], 0.9, False), paint(whole, np.s_[:70, :], 0.0, False)):
        quality = judge(behind)
        assert quality.inside == pytest.approx(quality.score, abs=1e-3) and quality.inside < 0.97
        assert quality.misfit > MISFIT and quality.is_lost and not quality.is_gone


@pytest.mark.parametrize("finger", range(1, 5))
def test_a_finger_that_is_bent_in_the_image_and_drawn_straight_is_misfit_on_both_sides(finger):
    bent = POSE.copy()
    own = 6 + list_finger_angles(RIGHT, finger)
    bent[own] = np.r_[np.zeros(6), curl_fingers(RIGHT, 0.9)][own]
    for seen, drawn in ((bent, POSE), (POSE, bent)):
        quality = judge(photograph(SCENE, seen), drawn)
        assert quality.misfit > quality.broad_misfit, FINGERS[finger]
        assert quality.misfit > MISFIT and quality.is_lost and not quality.is_gone


def test_misfit_is_the_area_without_a_rim_and_a_thing_narrower_than_two_rims_is_none():
    whole, z = photograph(SCENE, POSE), 0.45
    rim = round(RIM * FOCAL / z)
    column, row = 225, 80  # beside the fingers, 0.15 m from the palm
    for size in range(1, 12):
        quality = judge(paint(whole, np.s_[row : row + size, column : column + size], z, True))
        assert quality.misfit == pytest.approx(max(0, size - 2 * rim) ** 2 * (z / FOCAL) ** 2, rel=1e-4, abs=1e-12)
        assert quality.explained < 1.0


def test_a_forearm_behind_the_wrist_is_not_to_be_explained_but_what_sticks_out_before_it_is():
    whole = photograph(SCENE, POSE)
    column, row = np.rint(CAMERA.project(SCENE.pose_at(POSE).landmarks(0)[:1]))[0].astype(int)
    arm = judge(paint(whole, np.s_[row + 12 :, column - 15 : column + 16], 0.45, True))
    assert arm.explained > 0.98 and arm.misfit == 0.0 and not arm.is_lost
    assert arm.coverage < 0.9, "a hand that leaves pixels to pass for a forearm has less merit"
    assert arm.merit < judge(whole).merit
    finger = judge(paint(whole, np.s_[80:95, 225:240], 0.45, True))
    assert finger.misfit > MISFIT


def test_an_empty_image_and_a_hand_out_of_sight_are_gone_with_plain_numbers():
    nothing = photograph(SCENE, POSE)
    nothing = replace(nothing, depth=np.zeros((240, 320), np.float32), is_hand=np.zeros((240, 320), np.bool_))
    aside = move_pose(SCENE, se3.exp(np.array([3.0, 0, 0, 0, 0, 0])), POSE)
    for frame, pose in ((nothing, POSE), (photograph(SCENE, POSE), aside), (nothing, aside)):
        quality = judge(frame, pose)
        assert np.isfinite(np.delete(numbers(quality), 0)).all()
        assert quality.is_gone and quality.is_lost
        assert quality.score <= 0.0 or pose is aside
        assert quality.depth_residual == float("inf")


def test_a_short_stub_behind_the_wrist_is_no_forearm_and_one_that_the_border_cuts_off_may_go_on():
    whole = photograph(SCENE, POSE)
    column, row = np.rint(CAMERA.project(SCENE.pose_at(POSE).landmarks(0)[:1]))[0].astype(int)

    def explained(first: int, last: int) -> float:
        return judge(paint(whole, np.s_[first:last, column - 15 : column + 16], 0.45, True)).explained

    assert explained(row + 5, row + 50) < 0.85 < 0.95 < explained(row + 5, 240)


def test_what_of_the_hand_is_drawn_behind_the_wrist_and_not_seen_is_no_misfit():
    whole = photograph(SCENE, POSE)
    row = round(float(CAMERA.project(SCENE.pose_at(POSE).landmarks(0)[:1])[0, 1]))
    assert judge(paint(whole, np.s_[row:, :], 0.0, False)).misfit == 0.0
    assert judge(paint(whole, np.s_[row - 8 :, :], 0.0, False)).misfit > MISFIT


def test_what_is_only_drawn_and_what_is_only_seen_beside_it_are_two_areas_with_a_rim_each():
    whole = photograph(SCENE, POSE)
    assert whole.depth is not None
    rows, columns = np.mgrid[:240, :320]
    band = (rows >= 125) & (rows < 155)
    only_drawn = band & (columns < 150) & (whole.depth > 0)
    only_seen = band & (columns < 150) & (columns > 95) & (whole.depth == 0)
    one, other = paint(whole, only_drawn, 0.0, False), paint(whole, only_seen, 0.45, True)
    both = paint(one, only_seen, 0.45, True)
    areas = [judge(frame).misfit for frame in (one, other, both)]
    assert min(areas) > MISFIT
    assert areas[2] == pytest.approx(areas[0] + areas[1], rel=1e-6)


def test_skin_without_depth_in_the_shadow_of_the_hand_is_a_finger_for_who_draws_one_there_and_for_who_does_not():
    whole, images = photograph(SCENE, POSE), []
    assert whole.depth is not None
    for looks_like_skin in (True, False):
        is_hand = whole.depth > 0
        is_hand[:70] &= looks_like_skin
        color = np.where(is_hand[..., None], np.uint8([196, 140, 120]), np.uint8(20))
        images.append(replace(paint(whole, np.s_[:70, :], 0.0, False), color=color, is_hand=None))
    drawn, bent = POSE, np.r_[POSE[:6], curl_fingers(RIGHT, 0.9)]
    skin, dark = images
    assert judge(skin, drawn).misfit < MISFIT < judge(dark, drawn).misfit
    assert judge(skin, bent).misfit > judge(dark, bent).misfit + MISFIT
